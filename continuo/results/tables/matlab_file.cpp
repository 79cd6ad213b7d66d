// Lays out the variables of a MATLAB file of version 5, and fills their columns block by block: "MAT-File Format", The
// MathWorks.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include <continuo/results/families.hpp>
#include <continuo/results/tables/matlab_file.hpp>

namespace continuo::results {
namespace {

enum MatlabData : std::uint32_t {
  matlab_int8 = 1,
  matlab_uint16 = 4,
  matlab_int32 = 5,
  matlab_uint32 = 6,
  matlab_double = 9,
  matlab_matrix = 14
};
enum MatlabClass : std::uint32_t { matlab_cells = 1, matlab_letters = 4, matlab_numbers = 6 };
constexpr std::uint64_t most_bytes_of_array = 0x7fffffff;
constexpr std::size_t longest_name = 63;

void append_from_lowest(std::string& bytes, std::unsigned_integral auto number) {
  for (std::size_t k = 0; k < sizeof(number); ++k) bytes += static_cast<char>((number >> (8 * k)) & 0xff);
}
void append_tag(std::string& bytes, std::uint32_t type, std::uint64_t size) {
  append_from_lowest(bytes, type);
  append_from_lowest(bytes, static_cast<std::uint32_t>(size));
}
std::size_t padded(std::size_t size) {
  return (size + 7) / 8 * 8;
}
void append_element(std::string& bytes, MatlabData type, std::string_view data) {
  append_tag(bytes, type, data.size());
  bytes += data;
  bytes.resize(padded(bytes.size()));
}

/// An array up to its data, whose size is `data_bytes` with their tag.
std::string head_of_array(std::string_view name, MatlabClass kind, const std::vector<std::uint64_t>& sizes,
                          std::uint64_t data_bytes) {
  std::string flags, dimensions, inner;
  append_from_lowest(flags, std::uint32_t{kind});
  append_from_lowest(flags, std::uint32_t{0});
  for (const std::uint64_t size : sizes) append_from_lowest(dimensions, static_cast<std::uint32_t>(size));
  append_element(inner, matlab_uint32, flags);
  append_element(inner, matlab_int32, dimensions);
  append_element(inner, matlab_int8, name);
  std::string bytes;
  append_tag(bytes, matlab_matrix, inner.size() + data_bytes);
  return bytes + inner;
}

/// UTF-8 as UTF-16 units; what is none becomes U+FFFD.
std::string utf16(std::string_view utf8) {
  std::string units;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    const std::size_t length = lead < 0x80             ? 1
                               : (lead & 0xe0) == 0xc0 ? 2
                               : (lead & 0xf0) == 0xe0 ? 3
                               : (lead & 0xf8) == 0xf0 ? 4
                                                       : 0;
    std::uint32_t point = length == 1 ? lead : lead & (0x7fU >> length);
    bool is_good = length > 0 && i + length <= utf8.size();
    for (std::size_t k = 1; is_good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(utf8[i + k]);
      is_good = (next & 0xc0) == 0x80;
      point = point << 6 | (next & 0x3fU);
    }
    i += is_good ? length : 1;
    if (!is_good || point > 0x10ffff) point = 0xfffd;
    if (point >= 0x10000) {
      append_from_lowest(units, static_cast<std::uint16_t>(0xd800 + ((point - 0x10000) >> 10)));
      point = 0xdc00 + ((point - 0x10000) & 0x3ff);
    }
    append_from_lowest(units, static_cast<std::uint16_t>(point));
  }
  return units;
}

std::string text_array(std::string_view name, std::string_view value) {
  const std::string units = utf16(value);
  std::string data;
  append_element(data, matlab_uint16, units);
  return head_of_array(name, matlab_letters, {value.empty() ? 0U : 1U, units.size() / 2}, data.size()) + data;
}

std::string list_of_texts(std::string_view name, const std::vector<std::string>& texts) {
  std::string data;
  for (const std::string& one : texts) data += text_array("", one);
  return head_of_array(name, matlab_cells, {texts.size(), 1}, data.size()) + data;
}

/// The columns of a family with the first index running fastest, as MATLAB has its arrays.
std::vector<std::size_t> in_order_of_matlab(const ColumnFamily& family) {
  std::vector<std::size_t> places(family.places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t rest = i, there = 0, stride = 1;
    std::vector<std::size_t> index(family.axes.size());
    for (std::size_t k = family.axes.size(); k-- > 0; rest /= family.axes[k].count)
      index[k] = rest % family.axes[k].count;
    for (std::size_t k = 0; k < index.size(); stride *= family.axes[k].count, ++k) there += index[k] * stride;
    places[there] = family.places[i];
  }
  return places;
}

/// Where the column of a variable lies in the file.
struct ColumnPlace {
  std::size_t column;
  std::uint64_t at;
};

bool is_word_of_matlab(std::string_view name) {
  static constexpr std::array<std::string_view, 20> words{
      "break",  "case", "catch",     "classdef", "continue",   "else",   "elseif", "end",    "for", "function",
      "global", "if",   "otherwise", "parfor",   "persistent", "return", "spmd",   "switch", "try", "while"};
  return std::ranges::find(words, name) != words.end();
}

}  // namespace

std::string matlab_name(const std::string& name, std::vector<std::string>& taken) {
  std::string allowed;
  const std::size_t primes = static_cast<std::size_t>(std::ranges::count(name, '\''));
  for (const char c : name) {
    if (c == '\'' || c == ']') continue;
    const bool is_letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_letter || (!allowed.empty() && allowed.back() != '_')) allowed += is_letter ? c : '_';
  }
  if (primes > 0) allowed += fmt::format("_{}dot", std::string(primes - 1, 'd'));
  if (allowed.empty() || std::isalpha(static_cast<unsigned char>(allowed.front())) == 0) allowed.insert(0, "x_");
  if (is_word_of_matlab(allowed)) allowed += "_";
  allowed.resize(std::min(allowed.size(), longest_name));
  std::string result = allowed;
  for (int number = 2; std::ranges::find(taken, result) != taken.end(); ++number) {
    const std::string suffix = fmt::format("_{}", number);
    result = allowed.substr(0, longest_name - suffix.size()) + suffix;
  }
  taken.push_back(result);
  return result;
}

Status write_matlab(OutputFile& out, const std::vector<model::Column>& columns, const std::string& manifest,
                    StoredRows& rows) {
  std::string head = "MATLAB 5.0 MAT-file, written by Continuo";
  head.resize(124, ' ');
  std::fill(head.begin() + 116, head.end(), '\0');  // no data of a subsystem
  append_from_lowest(head, std::uint16_t{0x0100});
  head += "IM";
  std::vector<std::string> taken{"column_names", "column_units", "column_variables", "manifest"}, names, units,
      variables(columns.size());
  std::vector<ColumnPlace> places;
  std::uint64_t at = head.size();
  out.overwrite(0, head);
  for (const ColumnFamily& family : families_of(columns)) {
    const std::string name = matlab_name(family.name, taken);
    std::vector<std::uint64_t> sizes{rows.rows()};
    for (const ColumnFamily::Axis& axis : family.axes) sizes.push_back(axis.count);
    if (sizes.size() == 1) sizes.push_back(1);
    const std::uint64_t bytes = rows.rows() * family.places.size() * sizeof(double);
    if (bytes + 1024 > most_bytes_of_array) {
      out.fail(
          fmt::format("`{}` would have {} bytes, and a variable of this format has less than 2^31; -o x.nc has any "
                      "number",
                      name, bytes));
      return out.status();
    }
    std::string array = head_of_array(name, matlab_numbers, sizes, bytes + 8);
    append_tag(array, matlab_double, bytes);
    out.overwrite(at, array);
    at += array.size();
    for (const std::size_t column : in_order_of_matlab(family)) {
      places.push_back({column, at});
      at += rows.rows() * sizeof(double);
    }
    for (const std::size_t column : family.places) variables[column] = name;
  }
  for (const model::Column& column : columns) names.push_back(column.name), units.push_back(column.unit);
  out.overwrite(at, list_of_texts("column_names", names) + list_of_texts("column_units", units) +
                        list_of_texts("column_variables", variables) + text_array("manifest", manifest));
  for (std::uint64_t begin = 0; begin < rows.rows() && out.status(); begin += rows.rows_of_block()) {
    const std::uint64_t end = std::min(rows.rows(), begin + rows.rows_of_block());
    const std::vector<double> block = rows.block(begin, end);
    if (block.empty()) {
      out.fail("the rows cannot be read again");
      break;
    }
    std::string part;
    for (const ColumnPlace& place : places) {
      part.clear();
      for (std::size_t i = place.column; i < block.size(); i += rows.columns())
        append_from_lowest(part, std::bit_cast<std::uint64_t>(block[i]));
      out.overwrite(place.at + begin * sizeof(double), part);
    }
  }
  return out.status();
}

}  // namespace continuo::results
