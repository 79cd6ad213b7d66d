// Reads numbers whose highest byte comes first.
#include <algorithm>
#include <array>
#include <bit>

#include <continuo/results/tables/stored_rows.hpp>

namespace continuo::results {
namespace {
constexpr std::size_t bytes_of_block = std::size_t{1} << 20;
}

std::uint64_t StoredRows::rows_of_block() const {
  return std::max<std::uint64_t>(1, bytes_of_block / (columns_ * sizeof(double)));
}

std::vector<double> StoredRows::block(std::uint64_t begin, std::uint64_t end) {
  const std::size_t row_bytes = columns_ * sizeof(double), count = static_cast<std::size_t>(end - begin) * columns_;
  std::vector<std::array<unsigned char, sizeof(double)>> bytes(count);
  file_.seekg(static_cast<std::streamoff>(first_ + begin * row_bytes));
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count * sizeof(double)));
  if (!file_) return {};
  std::vector<double> values;
  values.reserve(count);
  for (const auto& number : bytes) {
    std::uint64_t bits = 0;
    for (const unsigned char byte : number) bits = bits << 8 | byte;
    values.push_back(std::bit_cast<double>(bits));
  }
  return values;
}

}  // namespace continuo::results
