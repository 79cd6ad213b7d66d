// continuo/continuo.hpp
// What most programs need: every method, solve with a method or without, and models in the language, loaded and run.
//
//   const auto decay = [](double, const std::array<double, 1>& x) { return std::array{-x[0]}; };
//   continuo::solve(decay, std::array{1.0}, {0.0, 1.0}, continuo::Tsitouras5{}, {.rtol = 1e-9}).final_state();
//
//   const auto loaded = continuo::model::load("models/pendulum.sim");
//   if (loaded) continuo::model::simulate(*loaded.model, {});
//
// Bodies, studies, results and the live view have headers of their own, directly in their modules.
#pragma once
#include <continuo/language/load.hpp>
#include <continuo/methods/all.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/automatic.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/solve/solve.hpp>
