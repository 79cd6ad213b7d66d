// What a continuo_model is in C++, and how a call into it keeps errors and exceptions inside.
#pragma once
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/c_interface/continuo.h>
#include <continuo/c_interface/handle/motion.hpp>
#include <continuo/language/load.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::c {

/// What went wrong last.
struct Error {
  std::string message, code, hint;
  int line = 0, column = 0;
};

}  // namespace continuo::c

/// A model with its options, its last run and the motion that is under way.
struct continuo_model {
  std::string name = "model";
  std::shared_ptr<const continuo::model::ModelProgram> program;  // null where the text is wrong
  std::string source_name, text;
  continuo::model::Experiment experiment;
  std::optional<continuo::model::Run> run;
  std::unique_ptr<continuo::c::Motion> motion;
  std::vector<continuo::c::PassedEvent> events;  // of the run or the motion
  std::string outcome;
  continuo::c::Error error;
  std::atomic<bool> interrupt{false};
};

namespace continuo::c {

/// Keeps this as what went wrong; returns the code.
int fail(continuo_model& model, int code, std::string message, std::string hint = {});
/// The first error among them, with the text of all.
int fail(continuo_model& model, int code, const std::vector<model::Diagnostic>& diagnostics);

/// A call that can fail, on a model that must be there: no exception leaves it.
template <class Work>
int call(continuo_model* model, Work&& work) noexcept {
  if (!model) return CONTINUO_MISUSE;
  try {
    model->error = {};
    return work(*model);
  } catch (const std::bad_alloc&) {
    return CONTINUO_MEMORY;
  } catch (const std::exception& problem) {
    try {
      return fail(*model, CONTINUO_ERROR, problem.what());
    } catch (...) {
      return CONTINUO_MEMORY;
    }
  } catch (...) {
    return CONTINUO_ERROR;
  }
}

/// The same for what needs a model without errors.
template <class Work>
int call_with_program(continuo_model* model, Work&& work) noexcept {
  return call(model, [&](continuo_model& m) {
    if (!m.program)
      return fail(m, CONTINUO_MISUSE, "the model has errors: it cannot be used", "see those of its loading");
    return work(m);
  });
}

/// Copies numbers to a buffer of that many.
int copy(continuo_model& model, std::span<const double> numbers, double* buffer, std::size_t count,
         std::string_view what);

}  // namespace continuo::c
