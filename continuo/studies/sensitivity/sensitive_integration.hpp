// Where sensitivities meet the methods: each is instantiated in a file of its own. Internal to sensitivity.
#pragma once
#include <functional>
#include <utility>
#include <vector>

#include <continuo/solve/integrator.hpp>
#include <continuo/studies/sensitivity/sensitive_events.hpp>

namespace continuo::studies::detail {

struct SensitiveIntegration {
  SensitiveSystem system;
  SensitiveSystem::X x0;
  Interval<double> interval;
  Options<SensitiveSystem::X> options;
  SensitiveEvents events;
};

struct SensitiveRows {
  std::function<double(std::size_t)> time;  // of each row, ascending, infinity after the last; empty: every step
  bool events = false;                      // rows on both sides of an event
  std::vector<double> times{}, values{};

  void keep(double t, const SensitiveSystem::X& x) {
    times.push_back(t);
    values.insert(values.end(), x.begin(), x.end());
  }
};

struct SensitiveEnding {
  Outcome<double> outcome;
  Statistics statistics;
  std::vector<SensitiveEventOccurrence> occurrences;
  Status status;  // a failure where the motion has no derivative
  std::size_t mode;
};

template <class Method>
[[nodiscard]] SensitiveEnding integrate_sensitive(SensitiveIntegration integration, SensitiveRows& rows);

struct SensitiveObserver {
  SensitiveRows& rows;
  SensitiveSystem::X x{};
  std::size_t next = 0;

  void upto(double t, const auto& at) {
    for (; rows.time && rows.time(next) <= t; ++next) {
      at(rows.time(next), x);
      rows.keep(rows.time(next), x);
    }
  }
  template <class I>
  void on_segment(I& integrator, double, double to) {
    const auto at = [&](double t, SensitiveSystem::X& state) { integrator.at(t, state); };
    upto(to, at);
    if (rows.time) return;
    at(to, x);
    rows.keep(to, x);
  }
  template <class I>
  void on_event(I& integrator, const EventOccurrence<SensitiveSystem::X>& now) {
    if (!rows.events) return;
    const bool declared =
        std::ranges::any_of(now.events, [&](std::size_t i) { return integrator.events().is_declared(i); });
    if (!declared || now.before == now.after) return;
    if (rows.times.empty() || rows.times.back() != now.t) rows.keep(now.t, now.before);
    rows.keep(now.t, now.after);
  }
};

/// The body; included only by the files that instantiate it.
template <class Method>
[[nodiscard]] SensitiveEnding integrate_sensitive_by(SensitiveIntegration integration, SensitiveRows& rows) {
  Integrator<SensitiveSystem, SensitiveSystem::X, Method, SensitiveEvents> integrator(
      std::move(integration.system), std::move(integration.x0), integration.interval, Method{},
      std::move(integration.options), std::move(integration.events));
  SensitiveObserver observer{.rows = rows, .x = integrator.x()};
  observer.upto(integration.interval.from, [&](double, SensitiveSystem::X& x) { x = integrator.x(); });
  if (!rows.time) rows.keep(integration.interval.from, integrator.x());
  for (std::size_t count = 1; integrator.advance(observer); ++count)
    if (count % 256 == 0 && integrator.options().progress) integrator.options().progress(integrator.t());
  if (rows.events && rows.times.back() != integrator.t()) rows.keep(integrator.t(), integrator.x());
  const auto occurrences = integrator.events().occurrences();
  return {integrator.outcome(),
          integrator.statistics(),
          {occurrences.begin(), occurrences.end()},
          integrator.events().status(),
          integrator.system().mode()};
}

}  // namespace continuo::studies::detail
