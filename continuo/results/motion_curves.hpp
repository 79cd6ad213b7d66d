// The curves of a motion, followed while it runs: between two rows or steps there are as many points as it takes for
// the straight lines between them to lie within a fraction of a pixel of the curve. What jumps at an event jumps.
//
//   MotionCurves curves(program, plot_requests(program->model));
//   const auto simulated = simulate(program, {}, curves);
//   draw(figure_of(*program, *simulated.run, curves), "ball.svg");
//
// A curve is known to a pixel of the range that it has had so far, which is a part of the range that it will have:
// where the picture turns out larger, there are more points than it takes, never fewer. Points that no picture shows
// are left out from time to time, so that a long motion takes no more memory than a short one.
//
// A method whose dense output is of the first order (Euler's methods, the implicit midpoint rule) knows no more of the
// motion between two steps than a straight line does: there the line goes straight from step to step.
#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <continuo/results/plot_request.hpp>
#include <continuo/results/quantity_tolerance.hpp>
#include <continuo/simulation/motion_watcher.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::results {

/// The ways of more bodies than these would be a tangle.
inline constexpr std::size_t most_ways = 20;

/// A line through points; where a number is not finite there is a gap.
struct Path {
  std::vector<double> x, y;
};

/// One curve of a plot.
struct MotionCurve {
  Path path;
  Path jumps;              // in a plane: from where the motion was to where an event put it, a gap after each
  double tolerance_x = 0;  // what the tolerances of the states leave open of its values
  double tolerance_y = 0;
};

/// Values of a family at one time.
struct Profile {
  double t;
  std::vector<double> x, y;
};

/// Follows the curves of plots while a motion is computed.
class MotionCurves final : public model::MotionWatcher {
 public:
  /// Follows the curves of these plots, or without any the states (up to eight), and the energy where there is one;
  /// of few bodies of a world their ways. The program may have been compiled apart from that of the run, of the same
  /// model with other plots.
  MotionCurves(std::shared_ptr<const model::ModelProgram> program, std::vector<PlotRequest> plots);

  /// The motion begins: its curves so far are one point.
  void begin(const model::Plan& plan, const X& x) override;
  /// Follows the curves over a piece of the motion.
  void on_piece(double to, const At& at) override;
  /// Puts the curves elsewhere.
  void on_jump(double t, const X& before, const X& after) override;

  /// In place of a motion that nobody has watched: its rows, with straight lines between them.
  void take_rows(const model::Run& run);

  /// Whether there is anything to draw yet.
  [[nodiscard]] bool has_begun() const { return last_.has_value(); }
  /// Whether plots were asked for, of the model or a caller.
  [[nodiscard]] bool was_asked() const { return was_asked_; }
  /// Whether the drift of the energy belongs to the picture; a caller who names plots sees those alone.
  [[nodiscard]] bool shows_drift() const { return shows_drift_; }
  /// Leaves the drift of the energy out of the picture.
  void leave_out_drift() { shows_drift_ = false; }
  /// The plots, those that were asked for or that of the states.
  [[nodiscard]] const std::vector<PlotRequest>& plots() const { return plots_; }
  /// The curves of a plot, in its order; none of a profile.
  [[nodiscard]] std::vector<MotionCurve> curves_of(std::size_t plot) const;
  /// The profiles of a plot, in the order of its times; none where the motion has not come there.
  [[nodiscard]] std::vector<Profile> profiles_of(std::size_t plot) const;
  /// The total energy over time, where the model has one.
  [[nodiscard]] std::optional<MotionCurve> energy() const;
  /// The way of a body in the plane, or in the projection of space to the plane; nothing where there are too many.
  [[nodiscard]] std::optional<Path> way_of(std::size_t body) const;

 private:
  struct Quantity {
    enum class Kind { time, state, node, right, up };
    Kind kind;
    std::size_t index = 0;  // of a state; of an output of the tape; of a body
    bool logarithmic = false;
  };
  struct Instant {
    double t;
    std::vector<double> values;  // of the quantities
  };
  struct Extent {
    double low = INFINITY, high = -INFINITY;
  };
  struct Track {
    std::size_t x, y;  // quantities
    MotionCurve curve{};
    std::size_t most_points = 0;
  };

  /// Of a plot: when its profiles are due, and those that have been taken.
  struct ProfileTimes {
    std::vector<std::size_t> order{};  // of the times, ascending
    std::size_t next = 0;              // in that order
    model::Evaluation evaluation{};    // the curves' values, then the places
    std::vector<std::optional<Profile>> taken{};
  };

  std::size_t add_quantity(Quantity quantity);
  std::size_t add_series(const model::Series& series, bool logarithmic);
  void add_plot(const PlotRequest& request);
  void add_states();
  void add_ways();
  void prepare(const model::Plan& plan, std::size_t states);
  MotionCurve with_tolerances(std::size_t track) const;
  Instant instant(double t, std::span<const double> x);
  Instant instant(double t, const At& at);
  void set_inputs(double t);
  void see(const Instant& instant);
  void see_tolerances(const Instant& instant, std::span<const double> x);
  double place(std::size_t quantity, double value) const;
  double extent(std::size_t quantity) const;
  bool bends(const Instant& a, const Instant& middle, const Instant& b) const;
  void follow(const Instant& a, const Instant& b, const At& at, int depth);
  void append(const Instant& instant);
  void append(Track& track, double x, double y);
  void take_profiles(double to, const At& at);
  void take_profile(std::size_t plot, std::size_t number, double t);

  std::shared_ptr<const model::ModelProgram> program_;
  std::vector<PlotRequest> plots_;
  std::vector<Quantity> quantities_;
  std::vector<model::NodeId> nodes_;
  std::vector<Track> tracks_;
  std::vector<std::vector<std::size_t>> tracks_of_plot_;
  std::optional<std::size_t> energy_track_;
  std::vector<std::size_t> way_tracks_;  // of each body; of none: no track
  std::vector<Extent> extents_;          // of each quantity, as places
  std::optional<QuantityTolerance> tolerances_;
  model::Evaluation evaluation_;
  std::vector<double> node_values_;
  std::vector<ProfileTimes> profiles_;  // of each plot
  std::optional<Instant> last_;
  X x_;
  double from_ = 0, to_ = 0, first_ = 0;  // first_: of rows at logarithmic times
  std::size_t pieces_ = 0, budget_ = 0;
  bool was_asked_ = false, shows_drift_ = true, is_straight_ = false;  // is_straight_: between two steps
};

}  // namespace continuo::results
