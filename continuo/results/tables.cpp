#include <cstddef>
#include <vector>

#include <continuo/results/csv.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/tables.hpp>

namespace continuo::results {

std::optional<std::string> write_motion(const Record& record, const std::string& path, std::string_view manifest_hash) {
  std::vector<std::string> names;
  for (const Column& column : record.motion.columns) names.push_back(column.name);
  OutputFile out(path);
  CsvWriter csv(out, manifest_hash, names);
  for (std::size_t i = 0; i < record.motion.rows() && !out.failure(); ++i) csv.row(record.motion.row(i));
  return out.close();
}

std::optional<std::string> write_events(const Record& record, const std::string& path, std::string_view manifest_hash) {
  std::vector<std::string> names{"event", "t"};
  for (const char* side : {"before ", "after "}) {
    for (const Column& column : record.state_columns()) names.push_back(side + column.name);
  }
  OutputFile out(path);
  CsvWriter csv(out, manifest_hash, names);
  std::vector<double> values;
  for (const EventRow& event : record.events) {
    values.assign(1, event.t);
    values.insert(values.end(), event.before.begin(), event.before.end());
    values.insert(values.end(), event.after.begin(), event.after.end());
    csv.row(event.name, values);
  }
  return out.close();
}

}  // namespace continuo::results
