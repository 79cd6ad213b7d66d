// continuo/results/report.cpp
// Assembles an HTML page with its style, texts and pictures.
#include <cstddef>

#include <continuo/results/report.hpp>

namespace continuo::results {

namespace {

constexpr std::string_view style_sheet = R"(
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { margin-bottom: 0.2rem; }
pre { background: color-mix(in srgb, currentColor 6%, transparent); border-radius: 6px; padding: 0.8rem; overflow-x: auto;
  font: 13px/1.45 ui-monospace, monospace; }
pre.messages { border-left: 4px solid #d55e00; }
code { font-family: ui-monospace, monospace; }
figure { margin: 1rem 0; background: #fff; border-radius: 6px; padding: 0.5rem; }
figure svg { width: 100%; height: auto; }
@media print { body { max-width: none; } pre { white-space: pre-wrap; } details { display: none; } }
)";

/// Without the XML declaration and the document type, which may stand only at the top of a file.
std::string_view only_svg(std::string_view svg) {
  const std::size_t begin = svg.find("<svg");
  return begin == std::string_view::npos ? std::string_view() : svg.substr(begin);
}

/// gnuplot names its markers and patterns alike in every picture: here each picture needs names of its own.
std::string with_own_names(std::string_view svg, std::size_t number) {
  std::string result;
  const std::string prefix = "p" + std::to_string(number) + "_";
  for (std::size_t i = 0; i < svg.size();) {
    bool named = false;
    for (const std::string_view before : {" id='", " id=\"", "href='#", "href=\"#", "url(#"}) {
      if (svg.substr(i, before.size()) != before) continue;
      result += before;
      result += prefix;
      i += before.size();
      named = true;
      break;
    }
    if (!named) result += svg[i++];
  }
  return result;
}

void append_section(std::string& page, const ReportSection& section, std::size_t number) {
  page += section.folded ? "<details><summary>" + escaped(section.title) + "</summary>\n"
                         : "<section><h2>" + escaped(section.title) + "</h2>\n";
  if (!section.command.empty()) page += "<p><code>" + escaped(section.command) + "</code></p>\n";
  if (!section.messages.empty()) page += "<pre class=\"messages\">" + escaped(section.messages) + "</pre>\n";
  if (!section.text.empty()) page += "<pre>" + escaped(section.text) + "</pre>\n";
  if (!only_svg(section.svg).empty())
    page += "<figure role=\"img\" aria-label=\"" + escaped(section.title) + "\">" +
            with_own_names(only_svg(section.svg), number) + "</figure>\n";
  page += section.folded ? "</details>\n" : "</section>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string report_page(std::string_view title, std::string_view heading, std::span<const ReportSection> sections) {
  std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" + escaped(title) +
          "</title>\n<style>";
  page += style_sheet;
  page += "</style>\n</head>\n<body>\n<h1>" + escaped(title) + "</h1>\n";
  if (!heading.empty()) page += "<p>" + escaped(heading.substr(0, heading.find("\n\n"))) + "</p>\n";
  for (std::size_t i = 0; i < sections.size(); ++i) append_section(page, sections[i], i);
  return page + "</body>\n</html>\n";
}

}  // namespace continuo::results
