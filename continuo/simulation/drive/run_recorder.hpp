// continuo/simulation/drive/run_recorder.hpp
// Watches an integration and keeps what a Run holds. Internal to simulate.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/event_names.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::model {

/// x(t) within the last stretch: any integrator, without being a template.
struct At {
  void* integrator;
  void (*call)(void* integrator, double t, std::vector<double>& x);
  void operator()(double t, std::vector<double>& x) const { call(integrator, t, x); }
};

/// The state at a time that some check asks for.
struct SampledState {
  double t;
  std::vector<double> x;  // empty until the run has come there
};

/// The extreme of an expression over the whole run.
struct Extremes {
  double low, high;
  double t_low, t_high;
};

/// What has been recorded since some moment, and what the recorder has to know to go on from there.
struct RecordedPart {
  std::vector<double> rows{}, total_energy{};  // as in Motion::values, Run::total_energy
  std::vector<RecordedEvent> events{};
  std::size_t next_output = 0, next_sample = 0;
  std::vector<SampledState> samples{};  // all that were taken
  std::vector<Extremes> extremes{};
  std::optional<EnergyBalance> energy{};
  std::vector<double> x{};
  double last_row = 0;
  bool any = false;
};

class RunRecorder {
 public:
  using X = std::vector<double>;

  /// `sample_times` ascending; `watched`: expressions whose extremes over the run are wanted.
  RunRecorder(const ModelProgram& program, const Plan& plan, bool keep_rows, std::vector<double> sample_times,
              std::span<const NodeId> watched, OnRow on_row = {});

  void begin(double t, const X& x);
  void on_segment(double to, const At& at);
  /// Up to when nothing of the motion is wanted.
  [[nodiscard]] double quiet_until() const;
  void on_event(double t, std::span<const EventName> names, const X& before, const X& after);
  /// Where nothing is interpolated: extremes at t, and samples up to t.
  void look(double t, const X& x) { watch(t, x); }
  void sample_until(double t, const X& x);
  /// Of bodies; before and after are not kept.
  void contact(double t, std::string name, double impulse);
  void finish(double t, const X& x);

  /// Collects the rows for `part` from now on. They are in memory until it is called.
  void collect_parts() { collects_parts_ = true; }
  /// What has been recorded since the last call.
  [[nodiscard]] RecordedPart part();
  /// How many bytes of rows that will be.
  [[nodiscard]] std::size_t bytes_of_part() const { return part_rows_.size() * sizeof(double); }
  /// Adds such a part, of a recorder of the same model and plan. False where it cannot be one.
  [[nodiscard]] bool add(const RecordedPart& part);

  [[nodiscard]] std::span<const SampledState> samples() const { return samples_; }
  /// When the next sample is wanted, infinity after the last; how many came before.
  [[nodiscard]] double next_sample() const;
  [[nodiscard]] std::size_t samples_taken() const { return next_sample_; }
  [[nodiscard]] std::span<const Extremes> extremes() const { return extremes_; }
  /// Whether who gets the rows wants no more of them.
  [[nodiscard]] bool is_refused() const { return is_refused_; }
  /// Moves what was kept into the run.
  void give(Run& run);

 private:
  void add_row(double t, const X& x);
  void hand_over();
  void keep_row();
  [[nodiscard]] bool wants_rows() const { return keep_rows_ || on_row_ || collects_parts_; }
  void watch(double t, const X& x);
  /// `take(sample)` for each that is wanted up to `to`, once.
  template <class Take>
  void take_samples(double to, Take&& take) {
    for (; next_sample_ < samples_.size() && samples_[next_sample_].t <= to; ++next_sample_)
      take(samples_[next_sample_]);
  }
  void set_inputs(Evaluation& evaluation, double t) const;
  void set_start_values(double t, const X& x);

  const ModelProgram& program_;
  OutputTimes times_;
  double start_;
  bool every_step_, keep_rows_;
  OnRow on_row_;
  bool is_refused_ = false, collects_parts_ = false;
  std::size_t next_output_ = 0, next_sample_ = 0;
  Motion motion_;
  std::vector<double> row_;  // that is being added
  std::vector<double> total_energy_;
  std::vector<RecordedEvent> events_;
  Evaluation quantities_, watched_;
  std::vector<double> quantity_values_, watched_values_;
  std::vector<double> start_variables_;  // empty where no check reads values at the start always
  std::vector<SampledState> samples_;
  std::vector<Extremes> extremes_;  // of the total energy and its scale (if any), then of `watched`
  std::optional<EnergyBalance> energy_;
  X x_;
  double last_row_ = 0;
  bool has_energy_, any_ = false;
  std::vector<double> part_rows_, part_energies_;  // since the last call of `part`
  std::size_t events_parted_ = 0;                  // by that call
};

}  // namespace continuo::model
