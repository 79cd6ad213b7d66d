// Writes the header and the records of a netCDF file in the classic format with 64-bit offsets: "The NetCDF Classic
// Format Specification", Unidata.
#include <algorithm>
#include <bit>
#include <concepts>

#include <continuo/results/netcdf_file.hpp>

namespace continuo::results {
namespace {

enum NetcdfTag : std::uint32_t {
  absent = 0,
  dimensions_follow = 0x0A,
  variables_follow = 0x0B,
  attributes_follow = 0x0C
};
enum NetcdfType : std::uint32_t { of_letters = 2, of_integers = 4, of_doubles = 6 };
constexpr std::uint64_t place_of_count = 4;  // behind the letters CDF and the version
constexpr std::uint64_t most_rows = 0x7fffffff, most_bytes_of_variable = 0xfffffffc;

void append_from_highest(std::string& bytes, std::unsigned_integral auto number) {
  for (std::size_t k = sizeof(number); k-- > 0;) bytes += static_cast<char>((number >> (8 * k)) & 0xff);
}
void append_from_highest(std::string& bytes, double number) {
  append_from_highest(bytes, std::bit_cast<std::uint64_t>(number));
}
void append_count(std::string& bytes, std::size_t count) {
  append_from_highest(bytes, static_cast<std::uint32_t>(count));
}
void pad(std::string& bytes) {
  bytes.append((4 - bytes.size() % 4) % 4, '\0');
}
void append_name(std::string& bytes, std::string_view name) {
  append_count(bytes, name.size());
  bytes += name;
  pad(bytes);
}

void append_attributes(std::string& bytes, const std::vector<NetcdfAttribute>& attributes) {
  const auto count = std::ranges::count_if(attributes, [](const NetcdfAttribute& one) { return !one.text.empty(); });
  append_count(bytes, count == 0 ? absent : attributes_follow);
  append_count(bytes, static_cast<std::size_t>(count));
  for (const NetcdfAttribute& attribute : attributes) {
    if (attribute.text.empty()) continue;
    append_name(bytes, attribute.name);
    append_count(bytes, of_letters);
    append_name(bytes, attribute.text);
  }
}

/// A variable as the file has it: texts are letters over one dimension more.
struct StoredVariable {
  const NetcdfVariable* variable;
  std::vector<std::size_t> dimensions;
  NetcdfType type = of_doubles;
  std::uint64_t size = 0;  // in the header, or of one record
  std::string bytes{};     // of what is no record

  bool is_record() const { return std::holds_alternative<NetcdfVariable::Columns>(variable->values); }
};

StoredVariable stored_variable(const NetcdfVariable& variable, std::vector<NetcdfDimension>& dimensions) {
  StoredVariable result{.variable = &variable, .dimensions = variable.dimensions};
  if (const auto* columns = std::get_if<NetcdfVariable::Columns>(&variable.values)) {
    result.size = columns->size() * sizeof(double);
  } else if (const auto* numbers = std::get_if<NetcdfVariable::Numbers>(&variable.values)) {
    for (const double number : *numbers) append_from_highest(result.bytes, number);
  } else if (const auto* whole = std::get_if<NetcdfVariable::Integers>(&variable.values)) {
    result.type = of_integers;
    for (const std::int32_t number : *whole) append_from_highest(result.bytes, static_cast<std::uint32_t>(number));
  } else {
    result.type = of_letters;
    const auto& texts = std::get<NetcdfVariable::Texts>(variable.values);
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    result.dimensions.push_back(dimensions.size());
    dimensions.push_back({"letters_of_" + variable.name, longest});
    for (const std::string& text : texts) result.bytes += text + std::string(longest - text.size(), '\0');
  }
  pad(result.bytes);
  if (!result.is_record()) result.size = result.bytes.size();
  return result;
}

/// The header; the places of variables are known where `begins` has them.
std::string header_of(const NetcdfLayout& layout, const std::vector<NetcdfDimension>& dimensions,
                      const std::vector<StoredVariable>& variables, const std::vector<std::uint64_t>& begins) {
  std::string bytes("CDF\2", 4);
  append_count(bytes, 0);
  append_count(bytes, dimensions.empty() ? absent : dimensions_follow);
  append_count(bytes, dimensions.size());
  for (const NetcdfDimension& dimension : dimensions) {
    append_name(bytes, dimension.name);
    append_count(bytes, dimension.size);
  }
  append_attributes(bytes, layout.attributes);
  append_count(bytes, variables.empty() ? absent : variables_follow);
  append_count(bytes, variables.size());
  for (std::size_t k = 0; k < variables.size(); ++k) {
    const StoredVariable& variable = variables[k];
    append_name(bytes, variable.variable->name);
    append_count(bytes, variable.dimensions.size());
    for (const std::size_t dimension : variable.dimensions) append_count(bytes, dimension);
    std::vector<NetcdfAttribute> attributes = variable.variable->attributes;
    if (variable.type == of_letters) attributes.push_back({"_Encoding", "utf-8"});
    append_attributes(bytes, attributes);
    append_count(bytes, variable.type);
    append_count(bytes, std::min(variable.size, most_bytes_of_variable + 3));
    append_from_highest(bytes, begins.empty() ? std::uint64_t{0} : begins[k]);
  }
  return bytes;
}

}  // namespace

NetcdfFile::NetcdfFile(const std::string& path, const NetcdfLayout& layout, std::string_view unfinished_ending)
    : out_(path, Unfinished::kept, unfinished_ending) {
  std::vector<NetcdfDimension> dimensions = layout.dimensions;
  std::vector<StoredVariable> variables;
  for (const NetcdfVariable& variable : layout.variables) variables.push_back(stored_variable(variable, dimensions));
  std::uint64_t place = header_of(layout, dimensions, variables, {}).size();
  std::vector<std::uint64_t> begins(variables.size());
  for (const bool records : {false, true}) {  // first what is written once
    if (records) first_row_ = place;
    for (std::size_t k = 0; k < variables.size(); ++k) {
      if (variables[k].is_record() != records) continue;
      begins[k] = place;
      place += variables[k].size;
    }
  }
  std::string bytes = header_of(layout, dimensions, variables, begins);
  for (const StoredVariable& variable : variables) {
    bytes += variable.bytes;
    if (const auto* columns = std::get_if<NetcdfVariable::Columns>(&variable.variable->values))
      columns_.insert(columns_.end(), columns->begin(), columns->end());
  }
  out_.write(bytes);
  out_.flush();
}

void NetcdfFile::row(std::span<const double> values) {
  if (rows_ == most_rows) return out_.fail("a netCDF file has no more rows than 2147483647; -o x.csv has any number");
  record_.clear();
  for (const std::size_t column : columns_) append_from_highest(record_, values[column]);
  ++rows_;
  const std::uint64_t before = out_.stored();
  out_.write(record_);
  if (out_.stored() != before) store_count();
}

void NetcdfFile::store_count() {
  std::string count;
  append_count(count, static_cast<std::size_t>(rows_));
  out_.overwrite(place_of_count, count);
}

Status NetcdfFile::close() {
  store_count();
  return out_.close();
}
Status NetcdfFile::leave() {
  store_count();
  return out_.leave();
}

}  // namespace continuo::results
