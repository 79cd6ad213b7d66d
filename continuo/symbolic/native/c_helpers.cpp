// The helpers of functions in C: mathematics that C lacks, tables, and operations on lanes.
#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_operations.hpp>
#include <continuo/symbolic/native/c_source.hpp>

namespace continuo::model {

namespace {

struct Helper {
  std::string_view name, text;
};
constexpr Helper helpers[] = {
    {"minimum", "static inline double minimum(double a, double b) { return b < a ? b : a; }\n"},
    {"maximum", "static inline double maximum(double a, double b) { return a < b ? b : a; }\n"},
    {"hypotenuse", "static inline double hypotenuse(double a, double b) { return sqrt(a*a + b*b); }\n"},
    {"modulo", "static inline double modulo(double a, double b) { return a - b*floor(a/b); }\n"},
    {"fused", "static inline double fused(double a, double b, double c) { return __builtin_fma(a, b, c); }\n"},
    {"sign_of", "static inline double sign_of(double a) { return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a; }\n"},
};

std::string numbers_of(std::span<const double> numbers) {
  std::string text;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    text += fmt::format("{}{}", number_text(numbers[k]), k + 1 == numbers.size() ? "" : k % 8 == 7 ? ",\n  " : ", ");
  return text;
}

/// The piece is found as std::upper_bound does, so that a table at NaN gives what a tape gives.
std::string text_of(const Table& table, std::size_t number, bool value, bool slope) {
  const std::span<const Table::Piece> pieces = table.all_pieces();
  std::vector<double> start, height, slopes;
  for (const Table::Piece& piece : pieces) {
    start.push_back(piece.x);
    height.push_back(piece.y);
    slopes.push_back(piece.slope);
  }
  std::string text = fmt::format(
      "static const double table_{0}_x[{1}] = {{\n  {2}}};\n"
      "static const double table_{0}_y[{1}] = {{\n  {3}}};\n"
      "static const double table_{0}_slope[{1}] = {{\n  {4}}};\n"
      "static inline int piece_of_table_{0}(double x) {{\n"
      "  int low = 0, high = {5};\n"
      "  while (low < high) {{\n"
      "    const int middle = low + (high - low)/2;\n"
      "    if (x < table_{0}_x[middle + 1]) high = middle; else low = middle + 1;\n"
      "  }}\n"
      "  return low;\n"
      "}}\n",
      number, pieces.size(), numbers_of(start), numbers_of(height), numbers_of(slopes), pieces.size() - 1);
  if (value) {
    text += fmt::format(
        "static inline double table_{0}(double x) {{\n"
        "  const int i = piece_of_table_{0}(x);\n"
        "  return table_{0}_y[i] + table_{0}_slope[i]*(x - table_{0}_x[i]);\n"
        "}}\n",
        number);
  }
  if (slope) {
    text += fmt::format(
        "static inline double slope_of_table_{0}(double x) {{ return table_{0}_slope[piece_of_table_{0}(x)]; }}\n",
        number);
  }
  return text;
}

/// Whether the text calls the function, and not one whose name ends the same.
bool calls(std::string_view text, const std::string& function) {
  const std::string call = function + "(";
  for (std::size_t at = text.find(call); at != std::string_view::npos; at = text.find(call, at + 1))
    if (at == 0 || (std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0 && text[at - 1] != '_')) return true;
  return false;
}

}  // namespace

std::string c_helpers(std::string_view functions, std::span<const Table> tables) {
  std::string text;
  for (const Helper& helper : helpers)
    if (calls(functions, std::string(helper.name))) text += helper.text;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const bool value = calls(functions, fmt::format("table_{}", i));
    const bool slope = calls(functions, fmt::format("slope_of_table_{}", i));
    if (value || slope) text += text_of(tables[i], i, value, slope);
  }
  return text;
}

namespace {

constexpr std::string_view lane_type =
    "#if defined(__AVX512F__)\n"
    "#define WIDTH 8\n"
    "#elif defined(__AVX2__)\n"
    "#define WIDTH 4\n"
    "#else\n"
    "#define WIDTH 2\n"
    "#endif\n"
    "typedef double lanes __attribute__((vector_size(8 * WIDTH)));\n"
    "typedef long long lane_masks __attribute__((vector_size(8 * WIDTH)));\n"
    "static inline lanes all_lanes(double a) { return a - (lanes){0}; }\n"
    "static inline lanes choose(lane_masks m, lanes a, lanes b) {\n"
    "  return (lanes)(((lane_masks)a & m) | ((lane_masks)b & ~m));\n"
    "}\n"
    "static inline lanes truth(lane_masks m) { return choose(m, all_lanes(1.0), all_lanes(0.0)); }\n";

constexpr Helper lane_choices[] = {
    {"select_less", "(lanes a, lanes b, lanes c, lanes d) { return choose(a < b, c, d); }"},
    {"select_less_equal", "(lanes a, lanes b, lanes c, lanes d) { return choose(a <= b, c, d); }"},
    {"select_nonzero", "(lanes a, lanes b, lanes c) { return choose(a != all_lanes(0.0), b, c); }"},
    {"is_less", "(lanes a, lanes b) { return truth(a < b); }"},
    {"is_less_equal", "(lanes a, lanes b) { return truth(a <= b); }"},
    {"is_equal", "(lanes a, lanes b) { return truth(a == b); }"},
    {"is_not_equal", "(lanes a, lanes b) { return truth(a != b); }"},
    {"are_both", "(lanes a, lanes b) { return truth((a != all_lanes(0.0)) & (b != all_lanes(0.0))); }"},
    {"is_either", "(lanes a, lanes b) { return truth((a != all_lanes(0.0)) | (b != all_lanes(0.0))); }"},
    {"is_not", "(lanes a) { return truth(a == all_lanes(0.0)); }"},
    {"each_minimum", "(lanes a, lanes b) { return choose(b < a, b, a); }"},
    {"each_maximum", "(lanes a, lanes b) { return choose(a < b, b, a); }"},
    {"each_fabs", "(lanes a) { return (lanes)((lane_masks)a & ~(lane_masks)all_lanes(-0.0)); }"},
    // Compilers before gcc 15 make eight numbers of the loop, and no vector.
    {"each_fused",
     "(lanes a, lanes b, lanes c) {\n"
     "#if defined(__AVX512F__)\n"
     "  return __builtin_ia32_vfmaddpd512_mask(a, b, c, -1, 4);\n"
     "#elif defined(__FMA__) && WIDTH == 4\n"
     "  return __builtin_ia32_vfmaddpd256(a, b, c);\n"
     "#elif defined(__FMA__)\n"
     "  return __builtin_ia32_vfmaddpd(a, b, c);\n"
     "#else\n"
     "  lanes y;\n"
     "  for (int i = 0; i < WIDTH; ++i) y[i] = __builtin_fma(a[i], b[i], c[i]);\n"
     "  return y;\n"
     "#endif\n}"},
    {"each_sign_of",
     "(lanes a) {\n"
     "  return choose(a > all_lanes(0.0), all_lanes(1.0), choose(a < all_lanes(0.0), all_lanes(-1.0), a));\n}"},
};

/// `NAME(` of the calls of each_NAME in the text that are no choices, each once.
std::vector<std::string> calls_for_each(std::string_view text) {
  constexpr std::string_view prefix = "each_";
  std::vector<std::string> names;
  for (std::size_t at = text.find(prefix); at != std::string_view::npos; at = text.find(prefix, at + 1)) {
    const std::string name(text.substr(at + prefix.size(), text.find('(', at) - at - prefix.size()));
    if (std::ranges::find(names, name) == names.end() &&
        std::ranges::find(lane_choices, "each_" + name, &Helper::name) == std::end(lane_choices))
      names.push_back(name);
  }
  return names;
}

bool takes_two(std::string_view function) {
  constexpr std::array two = {"pow", "atan2", "hypotenuse", "modulo"};
  return std::ranges::find(two, function) != two.end();
}

}  // namespace

std::string c_lane_helpers(std::string_view functions) {
  std::string text(lane_type);
  for (const Helper& helper : lane_choices)
    if (calls(functions, std::string(helper.name)))
      text += fmt::format("static inline lanes {}{}\n", helper.name, helper.text);
  for (const std::string& name : calls_for_each(functions)) {
    const bool two = takes_two(name);
    text += fmt::format(
        "static inline lanes each_{0}(lanes a{1}) {{\n"
        "  lanes y;\n"
        "  for (int i = 0; i < WIDTH; ++i) y[i] = {0}(a[i]{2});\n"
        "  return y;\n"
        "}}\n",
        name, two ? ", lanes b" : "", two ? ", b[i]" : "");
  }
  return text;
}

}  // namespace continuo::model
