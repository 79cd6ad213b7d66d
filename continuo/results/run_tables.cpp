// Writes the rows and the events of a run as CSV.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/run_tables.hpp>
#include <continuo/results/table_file.hpp>

namespace continuo::results {

Status write_motion(const model::Run& run, const std::string& path, std::string_view manifest_hash) {
  TableFile table(path, {.columns = run.motion.columns, .manifest = std::string(manifest_hash)});
  for (std::size_t i = 0; i < run.motion.rows() && table.status(); ++i) table.row(run.motion.row(i));
  return table.close();
}

Status write_events(const model::Run& run, const std::string& path, std::string_view manifest_hash) {
  const bool contacts = std::ranges::any_of(run.events, &model::RecordedEvent::is_contact);
  // Of a contact the states are not kept: where nothing else happened, there are no columns for them.
  const bool states = run.events.empty() || !std::ranges::all_of(run.events, &model::RecordedEvent::is_contact);
  std::vector<std::string> names{"event", "t"};
  if (contacts) names.emplace_back("impulse");
  for (const char* side : {"before ", "after "}) {
    for (std::size_t i = 1; states && i <= run.motion.states; ++i) names.push_back(side + run.motion.columns[i].name);
  }
  OutputFile out(path);
  CsvWriter csv(out, manifest_hash, names);
  std::vector<double> values;
  for (const model::RecordedEvent& event : run.events) {
    values.assign(1, event.t);
    if (contacts) values.push_back(event.impulse.value_or(std::nan("")));
    values.insert(values.end(), event.before.begin(), event.before.end());
    values.insert(values.end(), event.after.begin(), event.after.end());
    values.resize(names.size() - 1, std::nan(""));
    csv.row(event.name, values);
  }
  return out.close();
}

}  // namespace continuo::results
