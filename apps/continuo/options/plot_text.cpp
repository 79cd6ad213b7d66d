// Takes a text apart into curves, an axis, times and scales, and has the language check what is an expression.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <ranges>
#include <string_view>
#include <utility>

#include <apps/continuo/options/plot_text.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/language/load.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

constexpr std::size_t most_members = 100'000;  // of a family

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '\'' || c == '.';
}

/// So many characters of a text.
struct Stretch {
  std::size_t begin = 0, end = 0;
  bool empty() const { return begin >= end; }
};

/// A text of --plot, and what has been found wrong with it.
class PlotText {
 public:
  explicit PlotText(const std::string& text) : source_("--plot", text) {}

  std::string_view text() const { return source_.text(); }
  std::string_view slice(Stretch part) const { return text().substr(part.begin, part.end - part.begin); }
  Stretch trimmed(Stretch part) const {
    while (!part.empty() && std::isspace(static_cast<unsigned char>(text()[part.begin])) != 0) ++part.begin;
    while (!part.empty() && std::isspace(static_cast<unsigned char>(text()[part.end - 1])) != 0) --part.end;
    return part;
  }
  /// The parts between separators that are not within brackets.
  std::vector<Stretch> split(Stretch part, char separator) const {
    std::vector<Stretch> parts;
    int depth = 0;
    std::size_t begin = part.begin;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const char c = text()[i];
      if (c == '(' || c == '[') ++depth;
      if (c == ')' || c == ']') --depth;
      if (c == separator && depth <= 0) parts.push_back(trimmed({begin, i})), begin = i + 1;
    }
    parts.push_back(trimmed({begin, part.end}));
    return parts;
  }
  /// Where a word stands that is not within brackets; the end of the part where there is none.
  std::size_t find_word(Stretch part, std::string_view word) const {
    int depth = 0;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const char c = text()[i];
      if (c == '(' || c == '[') ++depth;
      if (c == ')' || c == ']') --depth;
      const bool begins = i == part.begin || !is_of_name(text()[i - 1]);
      const std::size_t after = i + word.size();
      if (depth == 0 && begins && after <= part.end && text().substr(i, word.size()) == word &&
          (after == part.end || !is_of_name(text()[after])))
        return i;
    }
    return part.end;
  }

  void fail(Stretch where, std::string message, std::string help = {}) {
    const model::Span span{static_cast<std::uint32_t>(where.begin),
                           static_cast<std::uint32_t>(std::max(where.end, where.begin + 1))};
    problems_.push_back(model::error("E348", span, std::move(message), {}, std::move(help)));
  }
  void add(model::Diagnostic problem) { problems_.push_back(std::move(problem)); }
  bool is_wrong() const { return !problems_.empty(); }
  void show_problems() const { show(problems_, source_); }

 private:
  model::Source source_;
  std::vector<model::Diagnostic> problems_;
};

/// A statement `plot` for the language, and where each of its characters comes from.
struct Statement {
  std::string text;
  std::vector<std::size_t> places;

  void add(std::string_view more, std::size_t place) {
    for (std::size_t i = 0; i < more.size(); ++i) places.push_back(place);
    text += more;
  }
  void add(const PlotText& from, Stretch part) {
    for (std::size_t i = part.begin; i < part.end; ++i) places.push_back(i);
    text += from.slice(part);
  }
};

/// One plot of a text, taken apart.
struct ReadPlot {
  std::size_t text = 0;  // which of the texts
  Statement curves, times, places;
  bool logarithmic_x = false, logarithmic_y = false;
  double first = 1;
  std::string label;
};

/// The numbers of "u[1..N]", and where they stand.
struct Members {
  long first = 1, last = 0;
  Stretch brackets;
};

class Reader {
 public:
  Reader(PlotText& text, const Prepared& prepared) : text_(text), prepared_(prepared) {}

  std::optional<ReadPlot> read(Stretch whole) {
    ReadPlot plot;
    take_scales(whole, plot);
    const std::size_t at = text_.find_word(whole, "at");
    const Stretch times = text_.trimmed({std::min(at + 2, whole.end), whole.end});
    const Stretch before = {whole.begin, at};
    const std::size_t against = text_.find_word(before, "against");
    const Stretch curves = text_.trimmed({before.begin, against});
    const Stretch axis = text_.trimmed({std::min(against + 7, before.end), before.end});
    if (curves.empty()) return fail(whole, "there is nothing to draw", "write the quantities, as in x, y against t");
    if (against < before.end && axis.empty())
      return fail({against, against + 7}, "what the curves are drawn against is missing",
                  "write y against x; for logarithmic axes y against x log xy, for a logarithm log(x)");
    if (at < whole.end && times.empty()) return fail({at, at + 2}, "the times are missing", "write at 0, 1, 5");
    const bool over_index = text_.slice(axis) == "index";
    if (over_index && at == whole.end)
      return fail(axis, "a curve over the index is one for each time, and no time is named",
                  "write at and the times, as in u[1..N] against index at 0, 1, 5");
    if (!add_items(curves, plot.curves, &plot)) return std::nullopt;
    if (at == whole.end) {
      if (!axis.empty()) plot.curves.add(" against ", axis.begin), plot.curves.add(text_, axis);
      return plot;
    }
    plot.label = std::string(text_.slice(curves));
    if (!add_items(times, plot.times, nullptr)) return std::nullopt;
    if (!axis.empty() && !over_index && !add_items(axis, plot.places, nullptr)) return std::nullopt;
    return plot;
  }

 private:
  std::nullopt_t fail(Stretch where, std::string message, std::string help = {}) {
    text_.fail(where, std::move(message), std::move(help));
    return std::nullopt;
  }

  /// `log x`, `log y`, `log xy` at the end, which it takes away.
  void take_scales(Stretch& whole, ReadPlot& plot) {
    while (true) {
      whole = text_.trimmed(whole);
      const std::string_view all = text_.slice(whole);
      const std::size_t last = all.find_last_of(" \t");
      if (last == std::string_view::npos) return;
      const std::string_view axes = all.substr(last + 1);
      const std::size_t word = all.find_last_not_of(" \t", last);
      if ((axes != "x" && axes != "y" && axes != "xy") || word == std::string_view::npos || word < 2 ||
          all.substr(word - 2, 3) != "log" || (word > 2 && is_of_name(all[word - 3])))
        return;
      plot.logarithmic_x = plot.logarithmic_x || axes != "y";
      plot.logarithmic_y = plot.logarithmic_y || axes != "x";
      whole.end = whole.begin + word - 2;
      whole = text_.trimmed(whole);
      if (!whole.empty() && text_.text()[whole.end - 1] == ',') --whole.end;
    }
  }

  /// Items between commas, families written out. `plot`: the one that gets the number of the first member.
  bool add_items(Stretch list, Statement& statement, ReadPlot* plot) {
    statement.add("plot ", list.begin);
    bool is_first = true;
    for (const Stretch item : text_.split(list, ',')) {
      if (item.empty()) return fail(list, "something is missing between commas"), false;
      const auto members = members_of(item);
      if (!members) return false;
      if (plot && is_first && !members->brackets.empty()) plot->first = static_cast<double>(members->first);
      for (long k = members->first; k <= members->last; ++k) {
        if (!is_first) statement.add(", ", item.begin);
        is_first = false;
        add_member(item, *members, k, statement);
      }
    }
    return true;
  }

  /// The item with [k] in place of every [a..b].
  void add_member(Stretch item, const Members& members, long k, Statement& statement) {
    if (members.brackets.empty()) return statement.add(text_, item);
    std::size_t from = item.begin;
    for (std::size_t i = item.begin; i < item.end; ++i) {
      if (text_.text()[i] != '[') continue;
      const std::size_t close = text_.text().find(']', i);
      if (close == std::string_view::npos || close >= item.end) break;
      if (text_.slice({i, close}).find("..") == std::string_view::npos) continue;
      statement.add(text_, {from, i});
      statement.add(fmt::format("[{}]", k), i);
      from = close + 1;
    }
    statement.add(text_, {from, item.end});
  }

  /// One member, without brackets, where the item names no family. Nothing where the numbers are wrong.
  std::optional<Members> members_of(Stretch item) {
    for (std::size_t open = item.begin; open < item.end; ++open) {
      if (text_.text()[open] != '[') continue;
      const std::size_t close = text_.text().find(']', open);
      if (close == std::string_view::npos || close >= item.end) break;
      const std::size_t dots = text_.slice({open, close}).find("..");
      if (dots == std::string_view::npos) continue;
      const auto first = whole_number({open + 1, open + dots}), last = whole_number({open + dots + 2, close});
      if (!first || !last) return std::nullopt;
      if (*last < *first || static_cast<std::size_t>(*last - *first) >= most_members)
        return fail({open, close + 1},
                    fmt::format("the numbers go from {} to {}, at most {} upwards", *first, *last, most_members));
      return Members{*first, *last, {open, close + 1}};
    }
    return Members{1, 1, {}};
  }

  /// A number, or a parameter with its value in this run.
  std::optional<long> whole_number(Stretch part) {
    part = text_.trimmed(part);
    const std::string name(text_.slice(part));
    long number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (!name.empty() && error == std::errc() && end == name.data() + name.size()) return number;
    const model::Model& model = prepared_.program->model;
    const std::size_t i = model::find_parameter(model, name);
    std::vector<std::string> names;
    for (const model::Parameter& parameter : model.parameters) names.push_back(parameter.name);
    if (i == model::npos) {
      return fail(part, fmt::format("`{}` is neither a number nor a parameter", name),
                  model::did_you_mean(name, names));
    }
    const auto given = prepared_.experiment.parameters.find(name);
    const double value = given != prepared_.experiment.parameters.end() ? given->second : model.parameters[i].value;
    if (std::abs(value) > 1e9 || value != std::floor(value))
      return fail(part, fmt::format("`{}` is {}, no whole number", name, value));
    return static_cast<long>(value);
  }

  PlotText& text_;
  const Prepared& prepared_;
};

/// What can stand in a plot, states first.
std::vector<std::string> names_of(const model::Model& model) {
  std::vector<std::string> names;
  for (const model::State& state : model.states) names.push_back(state.column);
  for (const auto* quantities : {&model.lets, &model.outputs, &model.energies})
    for (const model::Quantity& quantity : *quantities) names.push_back(quantity.name);
  for (const model::Parameter& parameter : model.parameters) names.push_back(parameter.name);
  for (const model::Input& input : model.inputs) names.push_back(input.name);
  return names;
}

/// A problem of the text with the plots, at its place in the text of --plot; the others have been told of the model.
void place_problem(const model::Diagnostic& problem, std::size_t begin, const Statement& statement,
                   const std::vector<std::string>& names, PlotText& text) {
  const std::size_t end = begin + statement.text.size();
  if (problem.span.begin < begin || problem.span.begin > end || statement.places.empty()) return;
  const auto place = [&](std::size_t at) {
    return at < begin + statement.places.size() ? statement.places[at - begin] : statement.places.back() + 1;
  };
  model::Diagnostic placed = problem;
  placed.span.begin = static_cast<std::uint32_t>(place(problem.span.begin));
  const std::size_t last = std::max<std::size_t>(problem.span.end, problem.span.begin + 1) - 1;
  placed.span.end = static_cast<std::uint32_t>(std::min(place(std::min(last, end)) + 1, text.text().size()));
  placed.span.end = std::max(placed.span.end, placed.span.begin);
  placed.related.clear();
  if (placed.code == "E210") {  // nothing can be declared here
    const std::string near = model::did_you_mean(text.slice({placed.span.begin, placed.span.end}), names);
    placed.help = near.empty() ? fmt::format("the model has {}", fmt::join(names | std::views::take(12), ", ")) : near;
  }
  text.add(std::move(placed));
}

/// All statements, at the end of the model's text; which of them begins where.
struct Extended {
  std::string text;
  std::vector<std::size_t> begins;

  void add(const Statement& statement) {
    begins.push_back(text.size());
    text += statement.text + "\n";
  }
};

/// The plots of the checked model, in the order of the statements, as what was asked.
std::vector<results::PlotRequest> requests_of(const model::Model& model, const std::vector<ReadPlot>& plots,
                                              std::size_t own, std::span<const double> variables) {
  std::vector<results::PlotRequest> requests;
  std::size_t next = own;
  for (const ReadPlot& plot : plots) {
    results::PlotRequest request{.plot = model.plots[next++],
                                 .logarithmic_x = plot.logarithmic_x,
                                 .logarithmic_y = plot.logarithmic_y,
                                 .first_place = plot.first,
                                 .profile_label = plot.label};
    if (!plot.times.text.empty()) {
      for (const model::Series& time : model.plots[next++].curves)
        request.times.push_back(evaluate(model, time.node, variables));
    }
    if (!plot.places.text.empty()) {
      const model::Plot& places = model.plots[next++];
      request.places = places.curves;
      request.plot.against = {places.curves.front().label, {}, places.curves.front().unit};
    }
    requests.push_back(std::move(request));
  }
  return requests;
}

}  // namespace

bool names_picture(const std::string& value) {
  static constexpr std::array<std::string_view, 20> endings = {
      ".svg", ".png",  ".pdf",  ".gif", ".mp4", ".jpg",  ".jpeg", ".bmp", ".eps", ".ps",
      ".tif", ".tiff", ".webp", ".avi", ".mov", ".webm", ".mkv",  ".mpg", ".m4v", ".html"};
  return value.find('/') == 0 ||
         std::ranges::any_of(endings, [&](std::string_view ending) { return value.ends_with(ending); });
}

std::optional<AskedPlots> read_plots(const std::vector<std::string>& texts, const Prepared& prepared) {
  const model::Model& model = prepared.program->model;
  if (texts.empty()) return AskedPlots{prepared.program, results::plot_requests(model)};
  std::vector<PlotText> sources(texts.begin(), texts.end());
  std::vector<ReadPlot> plots;
  Extended extended{prepared.loaded.source.text() + "\n", {}};
  for (std::size_t k = 0; k < sources.size(); ++k) {
    Reader reader(sources[k], prepared);
    const std::vector<Stretch> parts = sources[k].split({0, sources[k].text().size()}, ';');
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].empty() && i + 1 == parts.size() && i > 0) continue;  // after the last semicolon
      auto plot = reader.read(parts[i]);
      if (!plot) break;
      plot->text = k;
      plots.push_back(std::move(*plot));
    }
  }
  const auto is_wrong = [&] { return std::ranges::any_of(sources, &PlotText::is_wrong); };
  for (const ReadPlot& plot : plots)
    for (const Statement* statement : {&plot.curves, &plot.times, &plot.places})
      if (!statement->text.empty()) extended.add(*statement);
  model::CheckOptions options;
  if (prepared.decides_size) options.overrides = prepared.experiment.parameters;
  model::Loaded loaded{model::Source("", ""), {}, {}};
  if (!is_wrong()) {
    loaded = model::load(model::Source(prepared.loaded.source.name(), extended.text), options);
    std::size_t next = 0;
    for (const ReadPlot& plot : plots)
      for (const Statement* statement : {&plot.curves, &plot.times, &plot.places}) {
        if (statement->text.empty()) continue;
        const std::size_t begin = extended.begins[next++];
        for (const model::Diagnostic& problem : loaded.diagnostics)
          place_problem(problem, begin, *statement, names_of(model), sources[plot.text]);
      }
  }
  for (const PlotText& source : sources) source.show_problems();
  if (!loaded.model) {
    if (!is_wrong()) say("--plot: the text is no plot of this model");
    return std::nullopt;
  }
  const auto variables = start_values(*loaded.model, prepared.experiment.parameters);
  auto requests = requests_of(*loaded.model, plots, model.plots.size(), variables);
  return AskedPlots{model::compile(*std::move(loaded.model)), std::move(requests)};
}

std::optional<results::PictureSize> read_size(const std::string& text) {
  constexpr int least = 100, most = 10'000;
  results::PictureSize size;
  const char* const last = text.data() + text.size();
  const auto width = std::from_chars(text.data(), last, size.width);
  if (width.ec != std::errc() || width.ptr == last || *width.ptr != 'x') return std::nullopt;
  const auto height = std::from_chars(width.ptr + 1, last, size.height);
  const bool fits = height.ec == std::errc() && height.ptr == last && std::min(size.width, size.height) >= least &&
                    std::max(size.width, size.height) <= most;
  return fits ? std::optional(size) : std::nullopt;
}

}  // namespace continuo::app
