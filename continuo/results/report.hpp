// One page that holds everything: a model, what was asked of it, the answers, their pictures. HTML without any other
// file.
//
//   const std::string html = report_page("Ball", {{.title = "Run", .text = summary, .svg = picture}});
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace continuo::results {

/// One part of the page.
struct ReportSection {
  std::string title;
  std::string command{};   // what gives the same on a terminal; may be empty
  std::string text{};      // as printed
  std::string messages{};  // warnings and errors
  std::string svg{};       // an SVG file's content
  bool folded = false;     // shown on a click: long texts such as a manifest
};

/// `heading`: plain text, of which the first paragraph stands below the title; the rest is in the model.
[[nodiscard]] std::string report_page(std::string_view title, std::string_view heading,
                                      std::span<const ReportSection> sections);

/// Text with & < > " as HTML wants them.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace continuo::results
