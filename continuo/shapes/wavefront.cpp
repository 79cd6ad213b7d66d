// Reads the corners first, since faces may name corners of later lines. Polygons lose one ear after the other (G. H.
// Meisters, "Polygons have ears", Amer. Math. Monthly 82, 1975, 648-651), seen along their normal by M. E. Newell.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/mesh_check.hpp>
#include <continuo/shapes/wavefront.hpp>

namespace continuo {

namespace {

using Point = Vector<double, 3>;
using Flat = Vector<double, 2>;
using Loop = std::vector<std::uint32_t>;  // corners of a polygon

constexpr std::size_t most_corners_of_face = 200;

/// The next word of a line; empty at its end.
std::string_view next_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// The number that is the whole word.
template <class Number>
std::optional<Number> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

/// The number of a corner in a, a/b, a//c or a/b/c, where b and c are numbers as well.
std::optional<std::int64_t> corner_in(std::string_view word) {
  const std::string_view whole = word;
  std::array<std::string_view, 3> parts;
  std::size_t count = 0;
  while (count < parts.size()) {
    const std::size_t slash = word.find('/');
    parts[count++] = word.substr(0, slash);
    if (slash == std::string_view::npos) break;
    word.remove_prefix(slash + 1);
    if (count == parts.size()) return std::nullopt;
  }
  if (whole.ends_with('/')) return std::nullopt;
  for (const std::string_view part : {parts[1], parts[2]})
    if (!part.empty() && !number_of<std::int64_t>(part)) return std::nullopt;
  return number_of<std::int64_t>(parts[0]);
}

double twice_the_area(const Flat& a, const Flat& b, const Flat& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The corners of a polygon seen along its normal, so that they go counter-clockwise.
std::vector<Flat> seen_flat(const std::vector<Point>& corners) {
  Point normal{};
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += moment(Point(corners[i] - corners[0]), Point(corners[(i + 1) % corners.size()] - corners[0]));
  // Without the axis along which the normal is longest; the other two in the order in which the turn is kept.
  std::size_t along = 0;
  for (const std::size_t axis : {1U, 2U})
    if (std::abs(normal[axis]) > std::abs(normal[along])) along = axis;
  std::size_t first = (along + 1) % 3, second = (along + 2) % 3;
  if (normal[along] < 0) std::swap(first, second);
  std::vector<Flat> seen;
  for (const Point& corner : corners) seen.push_back({{corner[first], corner[second]}});
  return seen;
}

class WavefrontReader {
 public:
  explicit WavefrontReader(const std::string& name) : name_(name) {}

  Result<TriangleMesh<double>> read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // the mark that some programs put before UTF-8
    each_line(text, [&](std::string_view word, std::string_view rest) { return word != "v" || add_corner(rest); });
    each_line(text, [&](std::string_view word, std::string_view rest) {
      seen_ += word == "v" ? 1 : 0;
      return word != "f" || add_face(rest);
    });
    if (status_ && mesh_.triangles.empty())
      status_ = {.ending = Ending::unreadable, .message = "there are no faces: no lines `f 1 2 3`", .place = name_};
    if (!status_) return std::move(status_);
    return std::move(mesh_);
  }

 private:
  bool fail(std::string what) {
    status_ = {.ending = Ending::unreadable, .message = std::move(what), .place = name_ + ":" + std::to_string(line_)};
    return false;
  }

  /// act(first word, rest) for each line until it is false.
  template <class Act>
  void each_line(std::string_view text, Act&& act) {
    line_ = 0;
    while (!text.empty() && status_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      std::string_view line = text.substr(0, std::min(text.find_first_of("#\r\n"), end));
      const std::string_view word = next_word(line);
      if (!act(word, line)) return;
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  /// Behind the three numbers a weight or a colour may stand.
  bool add_corner(std::string_view rest) {
    Point& corner = mesh_.corners.emplace_back();
    for (double& x : corner.components) {
      const std::string_view word = next_word(rest);
      if (word.empty()) return fail("a corner needs three numbers, as in v 0 1 2.5");
      const auto value = number_of<double>(word);
      if (!value) return fail("`" + std::string(word) + "` is no number");
      if (!std::isfinite(*value)) return fail("`" + std::string(word) + "` is not finite");
      x = *value;
    }
    return true;
  }

  bool add_face(std::string_view rest) {
    Loop loop;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const auto number = corner_in(word);
      if (!number)
        return fail("`" + std::string(word) + "` is no corner of a face, which are as in f 1 2 3 or f 1/4/2 ...");
      const auto count = static_cast<std::int64_t>(*number > 0 ? mesh_.corners.size() : seen_);
      const std::int64_t index = *number > 0 ? *number - 1 : count + *number;
      if (*number == 0) return fail("corners are counted from 1, or from -1 backwards: there is no corner 0");
      if (index < 0 || index >= count)
        return fail("corner " + std::to_string(*number) + " of " + std::to_string(count));
      if (loop.size() == most_corners_of_face) return fail("a face has at most 200 corners");
      loop.push_back(static_cast<std::uint32_t>(index));
    }
    if (loop.size() < 3) return fail("a face needs three corners or more");
    return cut(std::move(loop));
  }

  /// The triangles of a polygon.
  bool cut(Loop loop) {
    std::vector<Flat> seen;
    if (loop.size() > 3) {
      std::vector<Point> corners;
      for (const std::uint32_t corner : loop) corners.push_back(mesh_.corners[corner]);
      seen = seen_flat(corners);
    }
    while (loop.size() > 3) {
      std::size_t ear = 1;
      while (ear <= loop.size() && !is_ear(loop, seen, ear % loop.size())) ++ear;
      if (ear > loop.size()) return fail("this face crosses itself, or has no area");
      ear %= loop.size();
      const std::size_t n = loop.size();
      if (!add({loop[(ear + n - 1) % n], loop[ear], loop[(ear + 1) % n]})) return false;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(ear));
      seen.erase(seen.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return add({loop[0], loop[1], loop[2]});
  }

  /// Whether the triangle of a corner and its neighbours is one, and holds no other corner.
  [[nodiscard]] bool is_ear(const Loop& loop, const std::vector<Flat>& seen, std::size_t k) const {
    const std::size_t n = loop.size(), before = (k + n - 1) % n, after = (k + 1) % n;
    const Flat &a = seen[before], &b = seen[k], &c = seen[after];
    if (!(twice_the_area(a, b, c) > 0) || !is_triangle({loop[before], loop[k], loop[after]})) return false;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == before || i == k || i == after || seen[i] == a || seen[i] == b || seen[i] == c) continue;
      if (twice_the_area(a, b, seen[i]) >= 0 && twice_the_area(b, c, seen[i]) >= 0 &&
          twice_the_area(c, a, seen[i]) >= 0)
        return false;
    }
    return true;
  }
  [[nodiscard]] bool is_triangle(const std::array<std::uint32_t, 3>& triangle) const {
    return is_facet<double, 3>({mesh_.corners[triangle[0]], mesh_.corners[triangle[1]], mesh_.corners[triangle[2]]});
  }
  bool add(const std::array<std::uint32_t, 3>& triangle) {
    if (!is_triangle(triangle)) return fail("this face has no area: leave it out");
    if (mesh_.triangles.size() == most_wavefront_triangles)
      return fail("there are more than " + std::to_string(most_wavefront_triangles) + " triangles");
    mesh_.triangles.push_back(triangle);
    return true;
  }

  const std::string& name_;
  TriangleMesh<double> mesh_;
  Status status_;
  std::size_t line_ = 0, seen_ = 0;  // seen_: corners before the present line
};

}  // namespace

Result<TriangleMesh<double>> parse_wavefront(std::string_view text, const std::string& name) {
  return WavefrontReader(name).read(text);
}

Result<TriangleMesh<double>> read_wavefront(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream)
    return Status{.ending = Ending::unreadable, .message = "the file cannot be read", .place = file.string()};
  return parse_wavefront(text, file.string());
}

}  // namespace continuo
