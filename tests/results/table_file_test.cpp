// Tables in every format, read back by readers of their own: what is in them, and that they are written row by row.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <netcdf.h>
#include <nlohmann/json.hpp>

#include "example.hpp"
#include <continuo/results/table_file.hpp>
#include <continuo/results/tables/matlab_file.hpp>

namespace continuo::results {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A reader of MATLAB files of version 5, after the format's description, which shares nothing with the writer.
class MatlabReader {
 public:
  struct Array {
    std::uint32_t kind = 0;
    std::vector<std::uint32_t> sizes;
    std::vector<double> numbers;
    std::string text;
    std::vector<std::string> texts;
  };
  explicit MatlabReader(const std::string& bytes) : bytes_(bytes) {
    EXPECT_THAT(bytes_.substr(0, 10), "MATLAB 5.0");
    EXPECT_EQ(bytes_.substr(126, 2), "IM");
    for (std::size_t at = 128; at < bytes_.size();) {
      const auto [name, array, end] = array_at(at);
      arrays[name] = array;
      at = end;
    }
  }
  std::map<std::string, Array> arrays;

 private:
  struct Named {
    std::string name;
    Array array;
    std::size_t end;
  };
  template <class T>
  T number_at(std::size_t at) const {
    T value{};
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }
  /// The bytes of an element, and where the next one begins.
  std::pair<std::string, std::size_t> element_at(std::size_t at, std::uint32_t type) const {
    EXPECT_EQ(number_at<std::uint32_t>(at), type) << at;
    const auto size = number_at<std::uint32_t>(at + 4);
    return {bytes_.substr(at + 8, size), at + 8 + (size + 7) / 8 * 8};
  }
  Named array_at(std::size_t at) const {
    EXPECT_EQ(number_at<std::uint32_t>(at), 14u);
    const std::size_t end = at + 8 + number_at<std::uint32_t>(at + 4);
    EXPECT_LE(end, bytes_.size());
    Named result{.name = {}, .array = {}, .end = end};
    const auto [flags, after_flags] = element_at(at + 8, 6);
    result.array.kind = static_cast<unsigned char>(flags[0]);
    const auto [sizes, after_sizes] = element_at(after_flags, 5);
    std::size_t count = 1;
    for (std::size_t i = 0; i < sizes.size(); i += 4) {
      std::uint32_t size = 0;
      std::memcpy(&size, sizes.data() + i, 4);
      result.array.sizes.push_back(size), count *= size;
    }
    const auto [name, after_name] = element_at(after_sizes, 1);
    result.name = name;
    if (result.array.kind == 6) {
      const auto [data, after] = element_at(after_name, 9);
      EXPECT_EQ(data.size(), 8 * count);
      EXPECT_EQ(after, end);
      result.array.numbers.resize(count);
      if (count > 0) std::memcpy(result.array.numbers.data(), data.data(), data.size());
    } else if (result.array.kind == 4) {
      const auto [data, after] = element_at(after_name, 4);
      for (std::size_t i = 0; i < data.size(); i += 2) result.array.text += data[i];
    } else {
      EXPECT_EQ(result.array.kind, 1u);
      std::size_t inner = after_name;
      for (std::size_t i = 0; i < count; ++i) {
        const Named one = array_at(inner);
        result.array.texts.push_back(one.array.text);
        inner = one.end;
      }
      EXPECT_EQ(inner, end);
    }
    return result;
  }
  const std::string bytes_;
};

const std::vector<model::Column> columns{{"t", "s"}, {"u[1]", "m"}, {"u[2]", "m"}, {"x'", "m/s"}, {"end", ""}};

/// Any bits that are a number, and some that are none.
std::vector<std::vector<double>> random_rows(std::size_t count) {
  std::mt19937_64 random(count);
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < count; ++i) {
    rows.push_back({static_cast<double>(i)});
    while (rows.back().size() < columns.size()) {
      const double value = std::bit_cast<double>(random());
      rows.back().push_back(std::isfinite(value) ? value : 0.5);
    }
  }
  if (count > 1) rows[1][1] = std::nan(""), rows[1][3] = std::numeric_limits<double>::infinity();
  return rows;
}

void write(const std::string& path, const std::vector<std::vector<double>>& rows) {
  TableFile table(path, {.columns = columns, .manifest = "abc"});
  for (const auto& row : rows) table.row(row);
  const Status status = table.close();
  ASSERT_TRUE(status) << status.message;
}

/// Bits, not values: nan is nan.
void expect_same(double a, double b) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << a << ' ' << b;
}

TEST(TableFile, OfMatlabHasAVariableForEachColumnAndFamily) {
  const Folder folder;
  for (const std::size_t count : {0u, 1u, 7u, 200'000u}) {  // the last in several blocks
    const auto rows = random_rows(count);
    write(folder / "a.mat", rows);
    const MatlabReader file(content(folder / "a.mat"));
    const auto size = static_cast<std::uint32_t>(count);
    EXPECT_THAT(file.arrays.at("t").sizes, ElementsAre(size, 1u));
    EXPECT_THAT(file.arrays.at("u").sizes, ElementsAre(size, 2u));
    EXPECT_THAT(file.arrays.at("column_names").texts, ElementsAre("t", "u[1]", "u[2]", "x'", "end"));
    EXPECT_THAT(file.arrays.at("column_units").texts, ElementsAre("s", "m", "m", "m/s", ""));
    EXPECT_THAT(file.arrays.at("column_variables").texts, ElementsAre("t", "u", "u", "x_dot", "end_"));
    EXPECT_EQ(file.arrays.at("manifest").text, "abc");
    for (std::size_t i = 0; i < count; ++i) {
      expect_same(file.arrays.at("t").numbers[i], rows[i][0]);
      expect_same(file.arrays.at("u").numbers[i], rows[i][1]);
      expect_same(file.arrays.at("u").numbers[count + i], rows[i][2]);
      expect_same(file.arrays.at("x_dot").numbers[i], rows[i][3]);
      expect_same(file.arrays.at("end_").numbers[i], rows[i][4]);
      if (HasFailure()) return;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.unfinished.nc"));
  }
}

TEST(TableFile, NamesForMatlabAreAllowedAndDiffer) {
  std::vector<std::string> taken;
  for (const auto& [name, expected] : {std::pair("x", "x"),
                                       {"x'", "x_dot"},
                                       {"x''", "x_ddot"},
                                       {"ball.x", "ball_x"},
                                       {"ball[1].x'", "ball_1_x_dot"},
                                       {"ball_x", "ball_x_2"},
                                       {"2x", "x_2x"},
                                       {"for", "for_"},
                                       {"\xce\xb8", "x_"},
                                       {"\xcf\x89", "x__2"}})
    EXPECT_EQ(matlab_name(name, taken), expected);
  const std::string shortened = matlab_name(std::string(100, 'a'), taken),
                    other = matlab_name(std::string(99, 'a'), taken);
  EXPECT_EQ(shortened.size(), 63u);
  EXPECT_EQ(other.size(), 63u);
  EXPECT_NE(shortened, other);
}

TEST(TableFile, OfJsonHasColumnsUnitsAndRows) {
  const Folder folder;
  for (const std::size_t count : {0u, 1u, 7u, 20'000u}) {
    const auto rows = random_rows(count);
    write(folder / "a.json", rows);
    const auto file = nlohmann::json::parse(content(folder / "a.json"));
    EXPECT_EQ(file["columns"], (nlohmann::json{"t", "u[1]", "u[2]", "x'", "end"}));
    EXPECT_EQ(file["units"], (nlohmann::json{"s", "m", "m", "m/s", ""}));
    EXPECT_EQ(file["manifest"], "abc");
    ASSERT_EQ(file["rows"].size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& row = file["rows"][i];
      ASSERT_EQ(row.size(), columns.size());
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const bool is_same = std::isfinite(rows[i][k]) ? row[k].get<double>() == rows[i][k] : row[k].is_null();
        ASSERT_TRUE(is_same) << i << ' ' << k;
      }
    }
  }
}

TEST(TableFile, OfNetcdfIsReadByItsLibrary) {
  const Folder folder;
  for (const std::size_t count : {0u, 1u, 7u, 20'000u}) {
    const auto rows = random_rows(count);
    write(folder / "a.nc", rows);
    int file = -1;
    ASSERT_EQ(nc_open((folder / "a.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      int variable = -1;
      ASSERT_EQ(nc_inq_varid(file, columns[k].name.c_str(), &variable), NC_NOERR) << columns[k].name;
      std::vector<double> values(count);
      ASSERT_EQ(nc_get_var_double(file, variable, values.data()), NC_NOERR);
      for (std::size_t i = 0; i < count; ++i) expect_same(values[i], rows[i][k]);
    }
    nc_close(file);
  }
}

TEST(TableFile, SeparatesByTabsWhereItsNameSaysSo) {
  const Folder folder;
  write(folder / "a.tsv", {{0, 1, 2, 3, 4}});
  EXPECT_EQ(content(folder / "a.tsv"), "# manifest abc\nt\tu[1]\tu[2]\tx'\tend\n0\t1\t2\t3\t4\n");
}

TEST(TableFile, ThatIsLeftHasTheNameOfAnUnfinishedOne) {
  for (const std::string ending : {"csv", "tsv", "nc", "json", "mat"}) {
    const Folder folder;
    TableFile table(folder / ("a." + ending), {.columns = columns});
    table.row(std::array{0.0, 1.0, 2.0, 3.0, 4.0});
    EXPECT_EQ(table.present_name(),
              folder / (std::string("a.unfinished.") + (ending.size() == 3 && ending != "mat" ? ending : "nc")));
    EXPECT_TRUE(table.leave());
    EXPECT_EQ(table.present_name(), folder / ("a.unfinished." + ending));
    EXPECT_FALSE(std::filesystem::exists(folder / ("a." + ending)));
  }
}

TEST(TableFile, OfAnotherEndingIsRefusedWithTheEndingsThatThereAre) {
  EXPECT_THAT(table_format("a.xlsx").status().message, HasSubstr(".csv, .tsv, .json, .nc (netCDF) or .mat (MATLAB)"));
  EXPECT_THAT(table_format("a.parquet").status().message, HasSubstr("to_parquet"));
  EXPECT_EQ(*table_format("-"), TableFormat::csv);
  EXPECT_EQ(*table_format("/dev/null"), TableFormat::csv);
  EXPECT_FALSE(check_table("/no such folder/a.csv"));
}

}  // namespace
}  // namespace continuo::results
