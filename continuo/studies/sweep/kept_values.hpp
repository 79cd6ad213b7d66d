// What a sweep keeps of a motion beside what a check can read: the largest, the smallest and the mean value of an
// expression, and its values at times, all on the dense output of the method.
//
//   const KeptNodes kept(program, plan.keeps);
//   KeptValues values(kept);
//   runs::run(program, experiment, {}, values);
//   values.of(0);
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <continuo/language/sweep.hpp>
#include <continuo/simulation/motion_watcher.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::studies {

/// The expressions that a motion is watched for, compiled once for all runs.
class KeptNodes {
 public:
  /// Those of `keeps` that are no readings.
  KeptNodes(std::shared_ptr<const model::ModelProgram> program, std::span<const model::SweepKeep> keeps);

  /// Whether there are none: then nobody needs to watch.
  [[nodiscard]] bool empty() const { return keeps_.empty(); }

 private:
  friend class KeptValues;
  std::shared_ptr<const model::ModelProgram> program_;
  std::vector<model::SweepKeep> keeps_;
  std::shared_ptr<const model::Tape> tape_;
};

/// Their values along one motion.
class KeptValues final : public model::MotionWatcher {
 public:
  /// `kept` must outlive this object.
  explicit KeptValues(const KeptNodes& kept);

  /// The motion begins; what was seen before is forgotten.
  void begin(const model::Plan& plan, const X& x) override;
  /// Looks at a piece of the motion.
  void on_piece(double to, const At& at) override;
  /// The motion goes on from elsewhere.
  void on_jump(double t, const X& before, const X& after) override;

  /// The values of one of the expressions, in their order: one number, of a series one for each time, NaN where the
  /// motion has not come there.
  [[nodiscard]] std::span<const double> of(std::size_t keep) const { return values_[keep]; }

 private:
  std::span<const double> evaluate(double t, std::span<const double> x);
  std::span<const double> evaluate(double t, const At& at);
  void see(double value, std::size_t keep);
  void take_samples(double to, const At& at);
  void look_between(std::size_t keep, const At& at);
  void search(double low, double high, std::size_t keep, const At& at);
  void take_times(double to, const At& at);
  void add_mean(double from, double to, std::size_t keep, const At& at, int depth);

  const KeptNodes& kept_;
  model::Evaluation evaluation_;
  std::vector<std::vector<double>> values_;  // of a mean the integral, until it is asked for
  std::vector<double> integrals_, sizes_;    // of the expression and of its absolute value
  std::vector<std::size_t> next_;            // of a series: the next time
  std::vector<double> now_;
  std::vector<double> sample_times_, samples_;  // of a piece; at each time one for each expression
  bool has_extremes_ = false;
  X x_;
  double from_ = 0, begin_ = 0;
};

}  // namespace continuo::studies
