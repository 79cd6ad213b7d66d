// continuo/foreign/foreign_run.hpp
// A run of a foreign system by a method named at run time, step by step, and what it has recorded so far.
//
//   const auto run = begin_foreign_run(functions, {1, 0}, {0, 10}, "dop853", {.rtol = 1e-9});
//   ForeignRecord record({.steps = true});
//   while (run->advance(record)) {}
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/foreign/foreign_system.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo {

/// The dense output of the steps of a run: polynomials one after another.
struct ForeignDense {
  /// One polynomial: x(t) = sum_j c_j theta^j, theta = (t - origin) / h, from begin to end.
  struct Piece {
    double begin, end, origin, h;
    std::size_t first, terms;  // the number of its first coefficient in `coefficients`, and of its terms
  };
  std::size_t size = 0;
  std::vector<Piece> pieces{};
  std::vector<double> coefficients{};  // of each piece: c_0, then c_1, ..., each of `size` numbers
  std::vector<double> ends{};          // x at the end of each piece: a polynomial gives it with a rounding

  /// Adds a piece with these coefficients, which ends at x.
  void add(double begin, double end, double origin, double h, std::span<const std::vector<double>> terms,
           const std::vector<double>& x);
  /// Adds one on which x stays.
  void add_constant(double begin, double end, const std::vector<double>& x);
  /// x at t, by a piece.
  void evaluate(std::size_t piece, double t, double* x) const;
};

/// What a run has recorded.
class ForeignRecord {
 public:
  using X = std::vector<double>;
  /// What is to be recorded.
  struct Wanted {
    bool steps = true;            // the state after every step, and on both sides of an event that changes it
    bool dense = false;           // the polynomial of every step
    std::vector<double> times{};  // the states at these times, in the direction of time
  };
  /// An event, with the state on both sides of it.
  struct Event {
    std::size_t number;  // in the order of the options
    double t;            // its time
    X before, after;     // the state before and after its action
  };

  /// An empty record.
  explicit ForeignRecord(Wanted wanted) : wanted_(std::move(wanted)) {}

  std::vector<double> t{}, x{};  // x: row after row
  ForeignDense dense{};
  std::vector<Event> events{};

  /// The state at the beginning.
  void begin(double time, const X& state) {
    dense.size = state.size();
    if (wanted_.steps) push(time, state);
  }
  /// A step has ended here.
  void step(double time, const X& state, bool ended_by_event) {
    if (wanted_.steps && (t.empty() || time != t.back() || changed_)) push(time, state);
    changed_ = false;
    // A run that an event has ended, ends where the event is said to be.
    if (wanted_.steps && !events.empty() && ended_by_event && t.back() == time && moved_from_ == time) {
      t.back() = events.back().t;
      std::copy(events.back().before.begin(), events.back().before.end(),
                x.end() - static_cast<std::ptrdiff_t>(state.size()));
    }
  }
  /// A run of no length, or of no components, ends here.
  void end_at(double time, const X& state) {
    if (wanted_.steps) push(time, state);
    for (const double one : wanted_.times) push(one, state);
    if (wanted_.dense) dense.add_constant(t.empty() ? time : t.front(), time, state);
  }

  /// As an observer of the run: the motion between two times stands.
  template <class Run>
  void on_segment(Run& run, double from, double to) {
    if (!wanted_.times.empty()) save_times(run, to, false);
    if (wanted_.dense) save_piece(run, from, to);
  }
  /// As an observer: events have fired.
  template <class Run>
  void on_event(Run& run, const EventOccurrence<X>& occurrence) {
    if (!occurred_) before_ = occurrence.before;
    occurred_ = true;
    changed_ = changed_ || occurrence.after != occurrence.before;
    for (const std::size_t i : occurrence.events) {
      if (occurrence.after == occurrence.before && is_noise(run, i, occurrence.t)) continue;
      events.push_back({i, occurrence.t, occurrence.before, occurrence.after});
      if (occurrence.after == occurrence.before) move_to_root(run, events.back());
    }
  }
  /// As an observer: all events of an instant have acted.
  template <class Run>
  void on_instant(Run& run) {
    if (occurred_ && changed_ && wanted_.steps && (t.empty() || t.back() != run.t())) push(run.t(), before_);
    occurred_ = false;
    if (!wanted_.times.empty()) save_times(run, run.t(), true);
  }

 private:
  // The rounding of a guard may carry it through zero several times where it passes once.
  template <class Run>
  [[nodiscard]] bool is_noise(Run& run, std::size_t event, double time) const {
    const double near = 1e-12 * (std::abs(time) + std::abs(run.step_size()));
    for (auto last = events.rbegin(); last != events.rend() && std::abs(last->t - time) <= near; ++last)
      if (last->number == event) return true;
    return false;
  }
  // An event lies just beyond its root, so that the motion goes on from there on the right side of it. One that
  // changes nothing is noted one number before, where its guard is nearer to zero: at 7 for t - 7.
  template <class Run>
  void move_to_root(Run& run, Event& event) {
    if (event.t == run.step_begin() || !run.events().is_guard(event.number)) return;
    const double before = std::nextafter(event.t, run.step_begin());
    std::vector<double> here(run.events().size()), there(here.size());
    X state = event.before;
    run.events().guards(run.system(), event.t, state, here);
    run.at(before, state);
    run.events().guards(run.system(), before, state, there);
    if (!(std::abs(there[event.number]) < std::abs(here[event.number]))) return;
    moved_from_ = event.t;
    event.t = before;
    event.before = event.after = state;
  }
  void push(double time, const X& state) {
    t.push_back(time);
    x.insert(x.end(), state.begin(), state.end());
  }
  // The states at the times up to `to`, or only those before it: what an event makes of the state is not known yet.
  template <class Run>
  void save_times(Run& run, double to, bool inclusive) {
    const double forward = run.interval().to < run.interval().from ? -1 : 1;
    for (; next_ < wanted_.times.size(); ++next_) {
      const double time = wanted_.times[next_], left = forward * (to - time);
      if (left < 0 || (left == 0 && !inclusive)) return;
      scratch_.resize(run.x().size());
      run.at(time, scratch_);
      push(time, scratch_);
    }
  }
  template <class Run>
  void save_piece(Run& run, double from, double to) {
    const double origin = run.step_begin(), h = run.step_size();
    if (from == to) return;
    if (!dense.pieces.empty()) {
      ForeignDense::Piece& last = dense.pieces.back();
      if (last.end == from && last.origin == origin && last.h == h) {
        last.end = to;
        std::copy(run.x().begin(), run.x().end(), dense.ends.end() - static_cast<std::ptrdiff_t>(dense.size));
        return;
      }
    }
    dense.add(from, to, origin, h, run.dense_output(), run.x());
  }

  Wanted wanted_;
  std::size_t next_ = 0;  // of the times
  bool occurred_ = false, changed_ = false;
  double moved_from_ = std::numeric_limits<double>::quiet_NaN();  // the time of the last event that was
  X before_, scratch_;
};

/// A run, whatever its system and its method.
class ForeignRun {
 public:
  using X = std::vector<double>;
  using Pointer = std::unique_ptr<ForeignRun>;

  virtual ~ForeignRun() = default;

  /// Takes one step, as Driver::advance. True while the run has not ended.
  virtual bool advance(ForeignRecord& record) = 0;
  /// The same without a record.
  virtual bool advance() = 0;
  /// The time reached.
  [[nodiscard]] virtual double t() const = 0;
  /// The state at that time.
  [[nodiscard]] virtual const X& x() const = 0;
  /// How the run has ended.
  [[nodiscard]] virtual const Outcome<double>& outcome() const = 0;
  /// The cost so far.
  [[nodiscard]] virtual Statistics statistics() const = 0;
  /// The dense output of the last step, from step_begin() on over step_size().
  [[nodiscard]] virtual std::span<const X> dense_output() = 0;
  /// The time at which the last step began.
  [[nodiscard]] virtual double step_begin() const = 0;
  /// The size of the last step.
  [[nodiscard]] virtual double step_size() const = 0;
  /// x at a time of the last step.
  virtual void at(double t, X& x) = 0;
  /// As Driver::set_state.
  virtual void set_state(const X& x) = 0;
  /// Begins anew from the present state, as after a change of what f reads.
  virtual void restart() = 0;
  /// As Driver::extend_to.
  virtual void extend_to(double to) = 0;
};

/// Begins the run of these functions by the method of that name. Null where it has no such method: for a mass that is a
/// full matrix there are radau5, radau, bdf and rodas5p.
[[nodiscard]] ForeignRun::Pointer begin_foreign_run(std::shared_ptr<const ForeignFunctions> functions,
                                                    std::vector<double> x0, Interval<double> interval,
                                                    std::string_view method, Options<std::vector<double>> options);

/// Whether begin_foreign_run knows this method for a mass that is a full matrix.
[[nodiscard]] bool solves_with_matrix(std::string_view method);

}  // namespace continuo
