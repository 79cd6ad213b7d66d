#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <tests/docs/shown_text.hpp>

namespace continuo::docs {
namespace {

constexpr double same_number = 0.01;        // relative: a page is no table of references
constexpr double nothing_but_noise = 1e-9;  // an energy drift of 2e-16 may be 4e-16 elsewhere

struct Piece {
  enum class Kind { word, number, anything } kind;
  std::string text;
};

std::vector<Piece> pieces_of(const std::string& line) {
  static const std::regex piece(
      R"(([0-9a-f]{64}|[0-9.]+(?:e[-+]?[0-9]+)? (?:ns|us|ms)\b|…))"  // hash, duration, wildcard
      R"(|([-+]?[0-9]+(?:\.[0-9]+)?(?:e[-+]?[0-9]+)?))"
      R"(|(\s+)|([A-Za-z_]+|.))");
  std::vector<Piece> pieces;
  for (std::sregex_iterator match(line.begin(), line.end(), piece), end; match != end; ++match) {
    if ((*match)[1].matched) {
      pieces.push_back({Piece::Kind::anything, ""});
    } else if ((*match)[2].matched) {
      pieces.push_back({Piece::Kind::number, (*match)[2].str()});
    } else if ((*match)[4].matched) {
      pieces.push_back({Piece::Kind::word, (*match)[4].str()});
    }
  }
  return pieces;
}

bool same(const Piece& shown, const Piece& printed) {
  if (shown.kind != Piece::Kind::number || printed.kind != Piece::Kind::number) return shown.text == printed.text;
  const double a = std::strtod(shown.text.c_str(), nullptr), b = std::strtod(printed.text.c_str(), nullptr);
  return std::abs(a - b) <= same_number * std::max(std::abs(a), std::abs(b)) + nothing_but_noise;
}

/// `wild(piece)` matches any run of parts, `equal` compares two others.
template <class Part, class Wild, class Equal>
bool matches(std::span<const Part> shown, std::span<const Part> printed, Wild wild, Equal equal) {
  if (shown.empty()) return printed.empty();
  if (wild(shown.front())) {
    for (std::size_t skip = 0; skip <= printed.size(); ++skip) {
      if (matches(shown.subspan(1), printed.subspan(skip), wild, equal)) return true;
    }
    return false;
  }
  return !printed.empty() && equal(shown.front(), printed.front()) &&
         matches(shown.subspan(1), printed.subspan(1), wild, equal);
}

bool same_line(const std::string& shown, const std::string& printed) {
  const auto is_wild = [](const Piece& piece) { return piece.kind == Piece::Kind::anything; };
  const auto a = pieces_of(shown), b = pieces_of(printed);
  return matches(std::span<const Piece>(a), std::span<const Piece>(b), is_wild, same);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  while (!lines.empty() && lines.back().find_first_not_of(" \t") == std::string::npos) lines.pop_back();
  return lines;
}

}  // namespace

bool shows(const std::string& shown, const std::string& printed) {
  const auto a = lines_of(shown), b = lines_of(printed);
  return matches(
      std::span<const std::string>(a), std::span<const std::string>(b),
      [](const std::string& line) { return line == "..."; }, same_line);
}

}  // namespace continuo::docs
