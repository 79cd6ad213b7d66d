// Asks the compiler of the model for code in lanes.
#include <continuo/simulation/program/fused_equations.hpp>
#include <continuo/simulation/together/integrate_together.hpp>
#include <continuo/simulation/together/lane_code.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model {

std::shared_ptr<NativeFunction> LaneCode::rates(const std::string& method, std::size_t mode) {
  NativeCompiler* const compiler = program_->model.native.get();
  if (!compiler) return nullptr;
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<NativeFunction>& code = rates_[{method, mode}];
  if (!code) code = compiler->lane_code(program_->derivatives[mode], step_formula(method), fusing_of(*program_));
  return code;
}

LaneDerivatives LaneCode::derivatives(std::size_t mode) {
  const std::scoped_lock lock(mutex_);
  if (!tapes_) tapes_ = std::make_shared<const DerivativeTapes>(derivative_tapes(*program_, false));
  std::shared_ptr<NativeFunction>& entries = entries_[mode];
  NativeCompiler* const compiler = program_->model.native.get();
  if (compiler && !entries) entries = compiler->lane_code(tapes_->modes[mode].entries);
  return {tapes_, entries, mode};
}

}  // namespace continuo::model
