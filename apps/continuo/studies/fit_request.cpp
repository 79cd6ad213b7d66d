// Reads the words of the command line of `continuo fit` into a request.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <span>
#include <utility>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/studies/fit_request.hpp>
#include <apps/continuo/studies/fit_units.hpp>
#include <apps/continuo/studies/influences.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/simulation/simulate.hpp>
#include <continuo/symbolic/graph/cells.hpp>

namespace continuo::app {
namespace {

using studies::ErrorModel;

/// `NAME=REST`, or nothing after saying so.
std::optional<std::pair<std::string, std::string>> split_setting(const std::string& text, std::string_view form) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size())
    return std::pair(text.substr(0, equals), text.substr(equals + 1));
  say(fmt::format("`{}` is not {}", text, form));
  return std::nullopt;
}

std::optional<double> positive(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  const auto value = model::cell_number(text);
  return value && *value > 0 && std::isfinite(*value) ? value : std::nullopt;
}

/// The place of a word in a list of names.
template <class Names>
std::optional<std::size_t> place_in(const Names& names, std::string_view word) {
  const auto found = std::find(std::begin(names), std::end(names), word);
  if (found == std::end(names)) return std::nullopt;
  return static_cast<std::size_t>(found - std::begin(names));
}

/// Which of the two is meant nobody knows.
bool given_twice(std::string_view option, const std::pair<std::string, std::string>& setting) {
  say(fmt::format("{} {}={}: `{}` is given twice", option, setting.first, setting.second, setting.first));
  return false;
}

class FitRequestReader {
 public:
  FitRequestReader(const FitOptions& options, const Prepared& prepared)
      : options_(options), model_(prepared.program->model) {
    request_.program = prepared.program;
    request_.experiment = prepared.experiment;
  }

  std::optional<studies::FitRequest> read() {
    if (!read_data() || !read_settings() || !read_errors() || !choose_columns() || !set_deviations() ||
        !to_units_of_model(request_) || !set_unknowns())
      return {};
    const auto loss = place_in(studies::loss_names, options_.loss);
    if (!loss) {
      say(no_such("loss", options_.loss, {std::begin(studies::loss_names), std::end(studies::loss_names)}));
      return {};
    }
    const auto likelihood = place_in(studies::likelihood_names, options_.likelihood);
    if (!likelihood) {
      say(no_such("likelihood", options_.likelihood,
                  {std::begin(studies::likelihood_names), std::end(studies::likelihood_names)}));
      return {};
    }
    request_.likelihood = static_cast<studies::Likelihood>(*likelihood);
    request_.options.loss = static_cast<studies::Loss>(*loss);
    request_.one_deviation = options_.one_deviation;
    request_.options.most_iterations = options_.iterations;
    request_.options.starts = options_.starts.value_or(1);
    if (options_.starts) request_.starts_in_doubt = 0;
    return std::move(request_);
  }

 private:
  bool read_data() {
    for (const std::string& file : options_.data) {
      auto read = measurements_in(file);
      if (!read) return false;
      std::error_code error;
      for (const studies::FitData& other : request_.data)
        if (other.measurements.file == file || std::filesystem::equivalent(other.measurements.file, file, error)) {
          say(fmt::format("{} is given twice: its values would count twice", file));
          return false;
        }
      request_.data.push_back({.measurements = *std::move(read), .columns = {}});
    }
    return true;
  }

  /// `a.csv:mass=2`: of one set.
  bool read_settings() {
    for (const std::string& text : options_.settings) {
      const std::size_t colon = text.rfind(':');
      const auto set = std::ranges::find(request_.data, name_of_file(text.substr(0, std::min(colon, text.size()))),
                                         [](const studies::FitData& data) { return data.measurements.file; });
      if (colon == std::string::npos || set == request_.data.end()) {
        say(fmt::format("`{}` is not FILE:NAME=VALUE with one of the data files", text));
        return false;
      }
      std::vector<model::Diagnostic> problems;
      const auto setting = model::parse_setting(model_, text.substr(colon + 1), problems);
      show(problems, model::Source("--in", text.substr(colon + 1)));
      if (!setting) return false;
      if (!set->parameters.emplace(setting->name, setting->value).second) {
        say(fmt::format("--in {}: `{}` is given twice for {}", text, setting->name, set->measurements.file));
        return false;
      }
    }
    return true;
  }

  bool is_column(const std::string& name) const {
    return std::ranges::any_of(request_.data, [&](const studies::FitData& data) {
      return place_in(data.measurements.columns, name).has_value();
    });
  }
  bool has_column(const std::string& name) const {
    if (is_column(name)) return true;
    say(no_such("column", name, request_.data.front().measurements.columns));
    return false;
  }

  bool read_errors() {
    for (const std::string& text : options_.errors) {
      const auto setting = split_setting(text, "COLUMN=MODEL");
      if (!setting || !has_column(setting->first)) return false;
      const auto error = place_in(studies::error_model_names, setting->second);
      if (!error) {
        say(no_such("error model", setting->second,
                    {std::begin(studies::error_model_names), std::end(studies::error_model_names)}));
        return false;
      }
      if (std::ranges::any_of(errors_, [&](const auto& one) { return one.first == setting->first; }))
        return given_twice("--error", *setting);
      errors_.emplace_back(setting->first, static_cast<ErrorModel>(*error));
    }
    std::vector<std::string> with_deviation;
    // A column that has the deviations of another one measures nothing itself.
    for (const std::string& text : options_.deviations) {
      const auto setting = split_setting(text, "COLUMN=DEVIATION");
      if (!setting || !has_column(setting->first)) return false;
      if (setting->first == setting->second) {
        say(fmt::format("--sigma {}: a column cannot contain its own deviations", text));
        return false;
      }
      if (place_in(with_deviation, setting->first)) return given_twice("--sigma", *setting);
      with_deviation.push_back(setting->first);
      if (is_column(setting->second)) of_deviations_.push_back(setting->second);
    }
    return true;
  }

  bool choose_columns() {
    std::vector<std::pair<std::string, std::string>> renamed;
    for (const std::string& text : options_.columns) {
      const auto setting = split_setting(text, "COLUMN=QUANTITY");
      if (!setting || !has_column(setting->first)) return false;
      if (std::ranges::any_of(renamed, [&](const auto& one) { return one.first == setting->first; }))
        return given_twice("--column", *setting);
      renamed.push_back(*setting);
    }
    const auto known = studies::quantities_of(model_);
    for (studies::FitData& data : request_.data) {
      for (std::size_t c = 0; c < data.measurements.columns.size(); ++c) {
        const std::string& name = data.measurements.columns[c];
        std::string quantity = name;
        for (const auto& [column, meant] : renamed)
          if (column == quantity) quantity = meant;
        if (quantity == "-" || place_in(of_deviations_, name)) continue;
        if (!place_in(known, quantity)) {
          say(fmt::format("{}:1: {} (--column {}=QUANTITY says which one is meant, --column {}=- leaves it out)",
                          data.measurements.file, no_such("state or output", quantity, known), name, name));
          return false;
        }
        data.columns.push_back({.column = c, .quantity = quantity});
        for (const auto& [column, error] : errors_)
          if (column == name) data.columns.back().error = error;
      }
      if (!data.columns.empty()) continue;
      say(fmt::format("{}:1: no column is left that measures anything", data.measurements.file));
      return false;
    }
    return true;
  }

  bool set_deviations() {
    for (const std::string& text : options_.deviations) {
      const auto setting = split_setting(text, "COLUMN=DEVIATION");
      if (!setting) return false;
      for (studies::FitData& data : request_.data)
        for (studies::FitColumn& column : data.columns)
          if (data.measurements.columns[column.column] == setting->first &&
              !set_deviation(data.measurements, column, text, setting->second))
            return false;
    }
    return true;
  }

  /// `0.01`, `5%`, `0.01+5%`, or the name of a column of deviations.
  bool set_deviation(const results::Measurements& measurements, studies::FitColumn& column, const std::string& text,
                     const std::string& deviation) const {
    const auto refused = [&](std::string_view why) {
      say(fmt::format("--sigma {}: {}", text, why));
      return false;
    };
    if (column.error == ErrorModel::poisson) return refused("counts have no deviation to be given: it is their root");
    if (const auto place = place_in(measurements.columns, deviation)) {
      if (column.error != ErrorModel::constant)
        return refused(fmt::format("deviations of each value leave nothing to the error model `{}`",
                                   studies::error_model_names[static_cast<std::size_t>(column.error)]));
      column.deviations_in = place;
      return true;
    }
    if (is_column(deviation)) return refused(fmt::format("{} has no column `{}`", measurements.file, deviation));
    const std::size_t plus = deviation.find('+', 1), end = deviation.size();
    const bool in_percent = deviation.ends_with('%');
    const bool is_sum = in_percent && plus != std::string::npos && positive(deviation.substr(0, plus));
    const std::size_t begin = is_sum ? plus + 1 : 0;
    const auto number = positive(std::string_view(deviation).substr(begin, end - begin - (in_percent ? 1 : 0)));
    if (!number)
      return refused("a deviation is a positive number: 0.01, 5%, 0.01+5%, or a column that has one for each value");
    const double value = in_percent ? *number / 100 : *number;
    if (is_sum) {
      if (column.error != ErrorModel::constant && column.error != ErrorModel::both)
        return refused("a sum is the error model `both`");
      column.error = ErrorModel::both;
      column.deviation = positive(deviation.substr(0, plus));
      column.relative = value;
    } else if (column.error == ErrorModel::lognormal) {
      column.deviation = value;
    } else if (in_percent) {
      const bool constant_asked = std::ranges::any_of(errors_, [&](const auto& asked) {
        return asked.first == measurements.columns[column.column] && asked.second == ErrorModel::constant;
      });
      if (constant_asked) return refused("it is the error model `proportional`, and `constant` was asked for");
      if (column.error == ErrorModel::constant) column.error = ErrorModel::proportional;
      column.relative = value;
    } else if (column.error == ErrorModel::proportional) {
      return refused(fmt::format("it is in proportion to the value: {}%", 100 * value));
    } else {
      column.deviation = value;
    }
    return true;
  }

  bool set_unknowns() {
    const auto influences = influences_named(model_, options_.parameters, options_.initial);
    if (!influences) return false;
    for (const studies::Influence& influence : *influences) {
      studies::FitUnknown unknown{.influence = influence};
      const std::string name = name_of(model_, influence);
      names_.push_back(name);
      if (influence.kind == studies::Influence::Kind::parameter) {
        const model::Parameter& parameter = model_.parameters[influence.index];
        if (parameter.range) unknown.low = parameter.range->low, unknown.high = parameter.range->high;
        for (const studies::FitData& data : request_.data) {
          if (!data.parameters.contains(parameter.name)) continue;
          say(fmt::format("`{}` cannot be fitted and be set in {} at once", parameter.name, data.measurements.file));
          return false;
        }
      }
      request_.unknowns.push_back(unknown);
    }
    const auto each = [](const std::vector<std::string>& list, auto set) { return std::ranges::all_of(list, set); };
    return each(options_.bounds, [&](const std::string& text) { return set_bounds(text); }) &&
           each(options_.logarithmic, [&](const std::string& text) { return set_logarithmic(text); }) &&
           each(options_.priors, [&](const std::string& text) { return set_prior(text); });
  }

  studies::FitUnknown* unknown(const std::string& name) {
    if (const auto place = place_in(names_, name)) return &request_.unknowns[*place];
    say(no_such("unknown", name, names_));
    return nullptr;
  }

  bool set_bounds(const std::string& text) {
    const auto setting = split_setting(text, "NAME=LOW..HIGH");
    if (!setting) return false;
    const std::size_t dots = setting->second.find("..");
    const auto side = [](const std::string& number, double none) {
      return number.empty() ? std::optional(none) : model::cell_number(number);
    };
    const double low = side(setting->second.substr(0, dots), -INFINITY).value_or(NAN);
    const double high =
        dots == std::string::npos ? NAN : side(setting->second.substr(dots + 2), INFINITY).value_or(NAN);
    if (!(low < high)) {  // or one is no number
      say(fmt::format("`{}` is not NAME=LOW..HIGH", text));
      return false;
    }
    studies::FitUnknown* found = unknown(setting->first);
    if (found == nullptr) return false;
    if (place_in(bounded_, setting->first)) return given_twice("--bounds", *setting);
    bounded_.push_back(setting->first);
    found->low = low, found->high = high;
    return true;
  }

  bool set_logarithmic(const std::string& name) {
    studies::FitUnknown* found = unknown(name);
    if (found == nullptr) return false;
    found->logarithmic = true;
    if (found->high > 0) return true;
    say(fmt::format("--log {}: its range has no positive numbers", name));
    return false;
  }

  /// `k=normal(4, 0.5)` or `k=lognormal(4, 0.2)`.
  bool set_prior(const std::string& text) {
    const auto setting = split_setting(text, "NAME=normal(MEAN, DEVIATION) or NAME=lognormal(MEDIAN, DEVIATION)");
    if (!setting) return false;
    const std::string& words = setting->second;
    const std::size_t open = words.find('('), comma = words.find(',');
    const std::string kind = words.substr(0, std::min(open, words.size()));
    const bool lognormal = kind == "lognormal";
    const bool shaped = open < comma && comma < words.size() && words.ends_with(')') && (lognormal || kind == "normal");
    std::optional<double> center, deviation;
    if (shaped) {
      std::string_view middle = std::string_view(words).substr(open + 1, comma - open - 1);
      while (middle.starts_with(' ')) middle.remove_prefix(1);
      while (middle.ends_with(' ')) middle.remove_suffix(1);
      center = model::cell_number(middle);
      deviation = positive(std::string_view(words).substr(comma + 1, words.size() - comma - 2));
    }
    if (!center || !std::isfinite(*center) || !deviation || (lognormal && !(*center > 0))) {
      say(fmt::format("`{}` is not NAME=normal(MEAN, DEVIATION) or NAME=lognormal(MEDIAN, DEVIATION)", text));
      return false;
    }
    studies::FitUnknown* found = unknown(setting->first);
    if (found == nullptr) return false;
    if (found->prior) return given_twice("--prior", *setting);
    using Kind = studies::FitPrior::Kind;
    found->prior = {.kind = lognormal ? Kind::lognormal : Kind::normal, .center = *center, .deviation = *deviation};
    return true;
  }

  const FitOptions& options_;
  const model::Model& model_;
  studies::FitRequest request_;
  std::vector<std::pair<std::string, ErrorModel>> errors_;
  std::vector<std::string> of_deviations_, names_, bounded_;
};

}  // namespace

std::optional<studies::FitRequest> fit_request(const FitOptions& options, const Prepared& prepared) {
  return FitRequestReader(options, prepared).read();
}

}  // namespace continuo::app
