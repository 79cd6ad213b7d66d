// continuo/studies/uncertainty.hpp
// Uncertain quantities: their distributions, the points at which a model is run, and what the outcomes say. For any
// function; `continuo sweep` uses the same for models.
//
//   const Result<Sampler> sampler = Sampler::create({.sampling = Sampling::sobol, .runs = 4096, .dimensions = 2});
//   OutcomeSummary summary;
//   for (std::uint64_t run = 0; run < 4096; ++run)
//     summary.add(f(quantile(Normal{5, 0.1}, sampler->at(run, 0)), quantile(Uniform{0, 1}, sampler->at(run, 1))));
//   summary.mean(), summary.quantiles(std::array{0.05, 0.95});
#pragma once
#include <continuo/studies/sweep/distribution.hpp>
#include <continuo/studies/sweep/morris.hpp>
#include <continuo/studies/sweep/outcome_summary.hpp>
#include <continuo/studies/sweep/sampling.hpp>
#include <continuo/studies/sweep/sobol_indices.hpp>
