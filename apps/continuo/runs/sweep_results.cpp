// Writes the table, the events, the picture and the manifest of a sweep, and prints its summary or its object.
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>

#include <apps/continuo/runs/sweep_results.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/json.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;
using Members = std::vector<SweepMember>;

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Json json_of(const Sweep& sweep, std::size_t member) {
  Json json = Json::object();
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) json[sweep.axes[a].column()] = sweep.value(member, a);
  return json;
}

/// The manifests of all runs in one, without the model's text in each.
std::string manifest_of(const Sweep& sweep, const Members& members, const std::string& hash) {
  Json json{{"continuo", CONTINUO_VERSION}, {"sweep", sweep.columns()}};
  Json runs = Json::array();
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!members[m].simulated.run) continue;
    const model::Model& model = members[m].program->model;
    Json one = Json::parse(results::manifest(model, *members[m].simulated.run, CONTINUO_VERSION));
    if (!json.contains("model")) json["model"] = one["model"];
    for (const char* same : {"continuo", "model"}) one.erase(same);
    Json entry = json_of(sweep, m);
    entry.update(one);
    runs.push_back(std::move(entry));
  }
  json["runs"] = std::move(runs);
  json["hash"] = hash;
  return text_of(json);
}

const model::Run* first_run(const Members& members) {
  for (const SweepMember& member : members)
    if (member.simulated.run) return &*member.simulated.run;
  return nullptr;
}

/// Rows of all runs have the same columns, unless a parameter decides how many equations there are.
bool have_one_table(const Members& members) {
  const model::Run* const first = first_run(members);
  const auto names = [](const model::Run& run) {
    std::vector<std::string> all;
    for (const model::Column& column : run.motion.columns) all.push_back(column.name);
    return all;
  };
  for (const SweepMember& member : members)
    if (member.simulated.run && names(*member.simulated.run) != names(*first)) return false;
  return true;
}

Status write_events(const Sweep& sweep, const Members& members, const std::string& path, const std::string& hash) {
  const model::Motion& motion = first_run(members)->motion;
  std::vector<std::string> columns{"event"};
  for (std::string& column : sweep.columns()) columns.push_back(std::move(column));
  columns.insert(columns.end(), {"t", "impulse"});
  for (const char* side : {"before ", "after "})
    for (std::size_t i = 1; i <= motion.states; ++i) columns.push_back(side + motion.columns[i].name);
  results::OutputFile out(path);
  results::CsvWriter csv(out, hash, columns);
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!members[m].simulated.run) continue;
    for (const model::RecordedEvent& event : members[m].simulated.run->events) {
      std::vector<double> row = sweep.values(m);
      row.push_back(event.t);
      row.push_back(event.impulse.value_or(std::nan("")));
      row.insert(row.end(), event.before.begin(), event.before.end());
      row.insert(row.end(), event.after.begin(), event.after.end());
      row.resize(columns.size() - 1, std::nan(""));
      csv.row(event.name, row);
    }
  }
  return out.close();
}

/// How many curves have a name; the others are jumps of those.
std::size_t named_curves(const results::Panel& panel) {
  return static_cast<std::size_t>(
      std::ranges::count_if(panel.curves, [](const results::Curve& curve) { return !curve.label.empty(); }));
}

/// Adds the curves of a run, named by what was swept, in the next colours of the panel; jumps keep the colour of their
/// curve.
void append_curves(results::Panel& all, results::Panel one, const std::string& member) {
  const std::size_t count = named_curves(one);
  std::size_t next = named_curves(all);
  std::map<std::size_t, std::size_t> colors;  // by the number of a run alone
  for (std::size_t i = 0; i < one.curves.size(); ++i) {
    results::Curve& curve = one.curves[i];
    const std::size_t own = curve.number.value_or(i);
    if (!curve.label.empty()) {
      colors[own] = next++;
      curve.label = count == 1 ? member : curve.label + ", " + member;
    }
    curve.number = colors.contains(own) ? colors[own] : own;
    all.curves.push_back(std::move(curve));
  }
}

/// The curves of all runs in the panels of one.
results::Figure figure_of(const Sweep& sweep, const Members& members) {
  results::Figure figure;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!members[m].simulated.run || !members[m].curves) continue;
    results::Figure one = results::figure_of(*members[m].program, *members[m].simulated.run, *members[m].curves);
    if (figure.title.empty()) figure.title = one.title;
    for (std::size_t p = 0; p < one.panels.size(); ++p) {
      if (p >= figure.panels.size()) {
        results::Panel& panel = figure.panels.emplace_back(one.panels[p]);
        panel.curves.clear();
        panel.marks.clear();  // each run has its own
      }
      append_curves(figure.panels[p], std::move(one.panels[p]), sweep.label(m));
    }
  }
  return figure;
}

/// The table is there already: here it is ended.
bool write_files(const Sweep& sweep, const Members& members, const RunOutputs& asked, SweepTable& table,
                 const std::string& hash) {
  const bool is_whole = !interrupt_flag().load();
  RunOutputs outputs = is_whole ? asked : unfinished(asked);
  if (!outputs.events.empty() && !have_one_table(members)) {
    say("the runs have different states, so they have no common table: leave out -o and --events");
    return false;
  }
  bool fine = written(table.finish(is_whole));
  if (!is_whole && !table.present_name().empty()) {
    outputs.motion = table.present_name();
    say(fmt::format("the rows until then are in {}", outputs.motion));
  }
  if (!outputs.events.empty()) fine = written(write_events(sweep, members, outputs.events, hash)) && fine;
  if (const std::string path = manifest_file(outputs); !path.empty())
    fine = written(results::write_file(path, manifest_of(sweep, members, hash))) && fine;
  if (!outputs.plot.empty()) fine = written(results::draw(figure_of(sweep, members), outputs.plot)) && fine;
  return fine;
}

/// What was run and how it ended; a run that could not begin is null, and says why.
Json object_of(const Sweep& sweep, const Members& members, const model::Source& source) {
  Json runs = Json::array();
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!members[m].begun) continue;
    Json one{{"at", json_of(sweep, m)}, {"run", nullptr}};
    const auto& simulated = members[m].simulated;
    if (simulated.run) one["run"] = Json::parse(results::run_json(*simulated.run));
    one["messages"] = Json::parse(model::to_json(simulated.diagnostics, source));
    runs.push_back(std::move(one));
  }
  return {{"swept", sweep.columns()}, {"runs", std::move(runs)}};
}

/// A line for each run: what it was run with, how it ended, where.
std::string summary_of(const Sweep& sweep, const Members& members) {
  constexpr std::size_t most_states = 6;
  const model::Run* const first = first_run(members);
  const bool one_table = first && have_one_table(members);
  std::vector<std::vector<std::string>> lines{sweep.columns()};
  lines.front().emplace_back("ending");
  lines.front().emplace_back("t");
  const std::size_t states = one_table ? std::min(first->motion.states, most_states) : 0;
  for (std::size_t i = 1; i <= states; ++i) lines.front().push_back(first->motion.columns[i].name);
  for (std::size_t m = 0; m < members.size(); ++m) {
    std::vector<std::string>& line = lines.emplace_back();
    for (const double value : sweep.values(m)) line.push_back(results::short_number(value));
    if (!members[m].simulated.run) {
      line.emplace_back(members[m].begun ? "not run" : "not begun");
      continue;
    }
    const model::Run& run = *members[m].simulated.run;
    line.emplace_back(to_string(run.outcome.ending));
    line.push_back(results::short_number(run.final_time()));
    for (std::size_t i = 0; i < states; ++i) line.push_back(results::short_number(run.final_state()[i]));
  }
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c) row += fmt::format("{:<{}}  ", line[c], widths[c]);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + '\n';
  }
  return text;
}

/// What went wrong, each message once with the first member that it is of.
void show_failures(const Sweep& sweep, const Members& members) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> failures;
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (const model::Diagnostic& diagnostic : members[m].simulated.diagnostics) {
      if (diagnostic.severity != model::Severity::error) continue;
      const std::string text = fmt::format("{} [{}]", diagnostic.message, diagnostic.code);
      const auto known = std::ranges::find(failures, text, &std::pair<std::string, std::vector<std::size_t>>::first);
      known == failures.end() ? failures.push_back({text, {m}}) : known->second.push_back(m);
    }
  }
  for (const auto& [text, of] : failures)
    say(fmt::format("{}{}: {}", sweep.label(of.front()),
                    of.size() > 1 ? fmt::format(" and {} more", of.size() - 1) : std::string(), text));
}

ExitCode exit_of(const Members& members) {
  bool has_failed = false;
  for (const SweepMember& member : members) {
    if (!member.begun) return interrupted;
    const auto& run = member.simulated.run;
    if (run && run->outcome.ending == Ending::interrupted) return interrupted;
    has_failed = has_failed || !run || !succeeded(run->outcome.ending);
  }
  return has_failed ? numerical_failure : done;
}

}  // namespace

ExitCode tell_sweep(const Sweep& sweep, const std::vector<SweepMember>& members, const Prepared& base,
                    const RunOutputs& outputs, SweepTable& table, const std::string& hash) {
  const bool any = first_run(members) != nullptr;
  const bool is_refused = table.is_refused();  // then runs that were not begun are none that were interrupted
  const bool fine = !any || write_files(sweep, members, outputs, table, hash);
  if (outputs.json) {
    answer("continuo.sweep/1", object_of(sweep, members, base.loaded.source));
  } else if (!outputs.data_to_standard_output()) {
    print(summary_of(sweep, members));
  }
  show_failures(sweep, members);
  const ExitCode exit = exit_of(members);
  return is_refused || (exit == done && !fine) ? usage : exit;
}

}  // namespace continuo::app
