// The report on a model's derivatives, as lines of text and as JSON.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/derivatives.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::results {
namespace {

using Json = nlohmann::ordered_json;
using model::DerivativeEntry;
using model::DerivativeReport;

constexpr std::size_t most_entries = 8;  // of a kind

std::string where(const DerivativeEntry& entry) {
  const std::string mode = entry.mode.empty() ? "" : fmt::format(" in mode {}", entry.mode);
  return fmt::format("{} at t = {}{}", entry.name, short_number(entry.t), mode);
}

/// A line each, the first with the heading, and how many more there are.
template <class Line>
void append_list(std::string& text, std::string_view heading, const std::vector<DerivativeEntry>& entries,
                 Line&& line) {
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < std::min(entries.size(), most_entries); ++i)
    fmt::format_to(out, "  {:<7} {}\n", i == 0 ? heading : "", line(entries[i]));
  if (entries.size() > most_entries) fmt::format_to(out, "  {:<7} and {} more\n", "", entries.size() - most_entries);
}

Json json_of(const DerivativeEntry& entry) {
  Json json{{"entry", entry.name}};
  if (!entry.mode.empty()) json["mode"] = entry.mode;
  json["t"] = entry.t;
  json["exact"] = entry.exact;
  json["difference"] = entry.measured;
  json["below"] = entry.below;
  json["above"] = entry.above;
  json["apart"] = entry.apart;
  return json;
}

Json json_of(const std::vector<DerivativeEntry>& entries) {
  Json json = Json::array();
  for (const DerivativeEntry& entry : entries) json.push_back(json_of(entry));
  return json;
}

}  // namespace

std::string derivatives_text(const DerivativeReport& report) {
  std::string text = fmt::format("  df/dx   {0} x {0}, pattern of {1}, reaching {2} below and {3} above the diagonal\n",
                                 report.states, report.entries, report.band.lower, report.band.upper);
  const std::string span =
      fmt::format("at {} times, {} to {}", report.points, short_number(report.from), short_number(report.to));
  if (report.agrees()) text += fmt::format("  right   by differences {}", span);
  if (report.agrees() && report.furthest && report.furthest->apart > 0) {
    text += fmt::format("; furthest off {} by {:.1g} of its row", where(*report.furthest), report.furthest->apart);
  }
  if (report.agrees()) text += '\n';
  append_list(text, "wrong", report.wrong, [](const DerivativeEntry& entry) {
    return fmt::format("{}: {}, by differences {}", where(entry), short_number(entry.exact),
                       short_number(entry.measured));
  });
  append_list(text, "kink", report.kinks, [](const DerivativeEntry& entry) {
    return fmt::format("{}: {} below, {} above, so there is no derivative; {} is used", where(entry),
                       short_number(entry.below), short_number(entry.above), short_number(entry.exact));
  });
  append_list(text, "open", report.undecided, [](const DerivativeEntry& entry) {
    return fmt::format("{}: {}, no difference is near enough to tell", where(entry), short_number(entry.exact));
  });
  return text;
}

std::string derivatives_json(const DerivativeReport& report) {
  Json json{{"agrees", report.agrees()},
            {"states", report.states},
            {"entries", report.entries},
            {"below_diagonal", report.band.lower},
            {"above_diagonal", report.band.upper},
            {"times", report.points},
            {"from", report.from},
            {"to", report.to},
            {"furthest", report.furthest ? json_of(*report.furthest) : Json()},
            {"wrong", json_of(report.wrong)},
            {"kinks", json_of(report.kinks)},
            {"undecided", json_of(report.undecided)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace continuo::results
