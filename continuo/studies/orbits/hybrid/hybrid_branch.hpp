// One place after the other on a branch of closed orbits through events: predicted along the tangent, corrected by
// Newton's iteration on the return. Internal to hybrid_continuation.
//
// Unknown are the state x where the orbit begins, the period T where no forcing sets it, and the parameter p:
//
//   flow(x, T, p) - x = 0,   f(y) . (x - y) = 0 without a forcing,   (z - guess) . tangent = 0,
//
// with y the place before (Keller 1977, as orbit_branch.hpp has it for smooth equations). A forcing's period may hang
// on p; then d flow / dp has x' dT/dp beside what the parameter itself does.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/studies/hybrid_continuation.hpp>
#include <continuo/studies/orbits/continuation/multiplier_tests.hpp>
#include <continuo/studies/orbits/hybrid/return_flow.hpp>

namespace continuo::studies::detail {

struct HybridPlace {
  model::Instant start;
  Eigen::VectorXd z{};        // x of the directions, T without a forcing, p; in sizes
  Eigen::VectorXd tangent{};  // of length 1
  OrbitPoint point{};         // its extremes only by `complete`
  std::vector<SensitivityEvent> events{};
  double noise = 0;  // what rounding leaves in the multipliers, about
  double fold = 0;   // the parameter's part of the tangent
  MultiplierTests tests{};
};

class HybridBranchSteps {
 public:
  /// `period`: of the orbit, about; `low`, `high`: between which its states go.
  HybridBranchSteps(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
                    const HybridContinuationOptions& options, double period, const std::vector<double>& low,
                    const std::vector<double>& high);

  /// The states that are solved for, by where a known orbit leads; false where there is none: `status` says why.
  [[nodiscard]] bool begin(const model::Instant& start, double period, double constant);

  /// The orbit near a start with this value of the parameter.
  [[nodiscard]] std::optional<HybridPlace> at_constant(const model::Instant& start, double period, double value);
  [[nodiscard]] std::optional<HybridPlace> at_constant(const HybridPlace& a, const HybridPlace& b, double value);
  /// A step along the branch. Nothing where none is found, or only one that is farther off than the step is long.
  [[nodiscard]] std::optional<HybridPlace> stepped(const HybridPlace& from, double step);
  /// The orbit near z whose distance from it has no part along `along`.
  [[nodiscard]] std::optional<HybridPlace> across(const model::Instant& start, const Eigen::VectorXd& z,
                                                  const Eigen::VectorXd& along);
  /// Where branches cross or the period doubles, the direction in which the equations hold beside that of the branch.
  [[nodiscard]] std::optional<Eigen::VectorXd> other_direction(const model::Instant& start, const Eigen::VectorXd& z,
                                                               const Eigen::VectorXd& along);
  /// The least and greatest values of the states.
  void complete(HybridPlace& place);
  /// Whether the orbit is within a hundredth of its extent of one place for a third of its period: near a homoclinic
  /// one all but a fixed time is spent there.
  [[nodiscard]] bool waits(const HybridPlace& place) const;
  /// Where an event comes near to where the orbit begins, it begins elsewhere.
  void begin_anew(HybridPlace& place);
  /// x half a period later less x: nothing is left of it where twice the same orbit is run through.
  [[nodiscard]] std::optional<Eigen::VectorXd> halves(const HybridPlace& place);

  [[nodiscard]] Eigen::VectorXd scaled(const model::Instant& start, double period, double constant) const;
  /// Of `scaled`, in the units of the model: x of the directions, T and p.
  [[nodiscard]] std::vector<double> unscaled_direction(const Eigen::VectorXd& direction) const;
  [[nodiscard]] Eigen::VectorXd scaled_direction(const std::vector<double>& direction) const;

  [[nodiscard]] double period_of(const Eigen::VectorXd& z) const;
  [[nodiscard]] double constant_of(const Eigen::VectorXd& z) const { return z[z.size() - 1] * range_; }
  [[nodiscard]] double size_of(std::size_t state) const { return sizes_[state]; }
  [[nodiscard]] bool is_forced() const { return options_.forcing.has_value(); }
  [[nodiscard]] const Status& status() const { return status_; }
  /// The events of the last orbit that was run, solved for or not.
  [[nodiscard]] const std::vector<SensitivityEvent>& last_events() const { return last_events_; }
  /// Of the forcing where the parameter has this value; nothing where none is known.
  [[nodiscard]] std::optional<double> forcing_at(double constant) const;

 private:
  struct Equations {
    FlowImage image;
    Eigen::VectorXd residual;
    Eigen::MatrixXd rows;  // by z
  };
  [[nodiscard]] Eigen::Index unknowns() const {
    return static_cast<Eigen::Index>(directions_.size()) + (is_forced() ? 0 : 1) + 1;
  }
  [[nodiscard]] model::Instant instant(const model::Instant& start, const Eigen::VectorXd& z) const;
  [[nodiscard]] std::optional<Equations> evaluate(const model::Instant& start, const Eigen::VectorXd& z,
                                                  const Eigen::VectorXd& reference, const Eigen::VectorXd& shift);
  [[nodiscard]] Eigen::VectorXd shift_at(const model::Instant& start, const Eigen::VectorXd& z);
  [[nodiscard]] std::optional<Eigen::VectorXd> corrected(const model::Instant& start, const Eigen::VectorXd& guess,
                                                         const Eigen::VectorXd& reference, const Eigen::VectorXd& last);
  [[nodiscard]] std::optional<HybridPlace> described(const model::Instant& start, const Eigen::VectorXd& z,
                                                     const Eigen::VectorXd& along);
  [[nodiscard]] model::Experiment experiment_at(double constant) const;

  std::shared_ptr<const model::ModelProgram> program_;
  const HybridContinuationOptions& options_;
  model::Experiment exact_;
  std::string name_;
  double range_, period_, turns_ = 0, forcing_ratio_ = 0;
  std::vector<double> sizes_;
  std::vector<std::size_t> directions_, held_;
  std::optional<ReturnFlow> flow_;
  Status status_;
  std::vector<SensitivityEvent> last_events_;
};

}  // namespace continuo::studies::detail
