// The machine code for runs in lanes, and what it is made of: each part made once, when a run asks for it.
#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <continuo/simulation/program/derivative_tapes.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/together/lane_derivatives.hpp>
#include <continuo/symbolic/native/native_function.hpp>

namespace continuo::model {

/// Threads may share it.
class LaneCode {
 public:
  explicit LaneCode(std::shared_ptr<const ModelProgram> program) : program_(std::move(program)) {}

  /// That of a mode's equations with the steps of this method; null where nobody compiles any.
  [[nodiscard]] std::shared_ptr<NativeFunction> rates(const std::string& method, std::size_t mode);
  /// df/dx and df/dt of a mode.
  [[nodiscard]] LaneDerivatives derivatives(std::size_t mode);

 private:
  std::shared_ptr<const ModelProgram> program_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::size_t>, std::shared_ptr<NativeFunction>> rates_;  // by method and mode
  std::shared_ptr<const DerivativeTapes> tapes_;
  std::map<std::size_t, std::shared_ptr<NativeFunction>> entries_;  // of df/dx, by mode
};

}  // namespace continuo::model
