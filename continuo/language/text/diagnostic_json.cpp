// Messages as JSON.
#include <nlohmann/json.hpp>

#include <continuo/language/text/diagnostic.hpp>

namespace continuo::model {

namespace {

using Json = nlohmann::ordered_json;

void add_places(Json& object, Span span, const Source& source) {
  const Place begin = source.place(span.begin), end = source.place(span.end);
  object["line"] = begin.line;
  object["column"] = begin.column;
  object["end_line"] = end.line;
  object["end_column"] = end.column;
}

Json as_json(const Diagnostic& diagnostic, const Source& source) {
  constexpr const char* severities[] = {"error", "warning", "note"};
  Json object;
  object["code"] = diagnostic.code;
  object["severity"] = severities[static_cast<int>(diagnostic.severity)];
  object["message"] = diagnostic.message;
  object["label"] = diagnostic.label;
  object["help"] = diagnostic.help;
  object["file"] = source.name();
  add_places(object, diagnostic.span, source);
  object["related"] = Json::array();
  for (const Related& related : diagnostic.related) {
    Json other;
    other["label"] = related.label;
    add_places(other, related.span, source);
    object["related"].push_back(std::move(other));
  }
  return object;
}

// A file name may hold any bytes; those that are not UTF-8 become U+FFFD.
std::string as_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string to_json(const Diagnostic& diagnostic, const Source& source) {
  return as_text(as_json(diagnostic, source));
}

std::string to_json(std::span<const Diagnostic> diagnostics, const Source& source) {
  Json array = Json::array();
  for (const Diagnostic& diagnostic : diagnostics) array.push_back(as_json(diagnostic, source));
  return as_text(array);
}

}  // namespace continuo::model
