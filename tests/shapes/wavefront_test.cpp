// Wavefront OBJ files: what is read is held against areas and volumes that follow from the polygons as written, random
// files against the mesh that they were written from, and broken ones against the line that is wrong.
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/wavefront.hpp>

namespace continuo::wavefront_test {
namespace {

/// "v 1 0.1 -3\n", each number as the shortest text that reads back as it.
template <class Number>
std::string line(const std::string& word, std::initializer_list<Number> numbers) {
  std::string text = word;
  for (const Number number : numbers) {
    std::array<char, 32> digits{};
    text += " " + std::string(digits.data(), std::to_chars(digits.begin(), digits.end(), number).ptr);
  }
  return text + "\n";
}

TriangleMesh<double> read(const std::string& text) {
  auto mesh = parse_wavefront(text, "m.obj");
  EXPECT_TRUE(mesh) << describe(mesh.status());
  return mesh ? *std::move(mesh) : TriangleMesh<double>{};
}
std::string refusal(const std::string& text) {
  const auto mesh = parse_wavefront(text, "m.obj");
  EXPECT_FALSE(mesh) << text;
  return mesh.status().place + ": " + mesh.status().message;
}

/// Half the sum of the cross products of all triangles: that of the border alone (Stokes), however it is cut; and the
/// sum of their sizes, which is its length only where no triangle is turned over.
struct Area {
  Vector<double, 3> directed{};
  double sum = 0;
};
Area area(const TriangleMesh<double>& mesh) {
  Area area;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector<double, 3> twice = moment(Vector<double, 3>(mesh.corners[b] - mesh.corners[a]),
                                           Vector<double, 3>(mesh.corners[c] - mesh.corners[a]));
    area.directed += twice * 0.5;
    area.sum += 0.5 * length(twice);
  }
  return area;
}

TEST(Wavefront, ReadsCornersInEverySpelling) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1", "f -3 -2 -1",
                                 "  f\t1  2\t3  ", "f 1 2 3 # a face", "f +1 2 3", "f -3/-1/-1 -2//-1 3"}) {
    const TriangleMesh<double> mesh = read(corners + face + "\n");
    ASSERT_EQ(mesh.triangles.size(), 1U) << face;
    EXPECT_THAT(mesh.triangles[0], testing::ElementsAre(0, 1, 2)) << face;
  }
  // What is no corner and no face has no meaning; lines may end as on Windows, a face may come before its corners.
  const TriangleMesh<double> mesh = read(
      "\xEF\xBB\xBF# a hill\r\nmtllib a.mtl\r\no hill\r\nf 1 2 3\r\nv 1e-1 +2 -3.5 1\r\nv 1 0 0 0.5 0.5 0.5\r\n"
      "vn 0 0 1\r\nvt 0 0\r\ns off\r\nusemtl x\r\nv 0 1 0\r\nl 1 2\r\n");
  EXPECT_THAT(mesh.corners[0].components, testing::ElementsAre(0.1, 2, -3.5));
  EXPECT_EQ(mesh.corners.size(), 3U);
}

// Negative numbers count back from the line where they stand.
TEST(Wavefront, CountsBackFromTheLine) {
  const TriangleMesh<double> mesh =
      read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf -3 -2 -1\n");
  EXPECT_THAT(mesh.triangles[0], testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.triangles[1], testing::ElementsAre(3, 4, 5));
}

// A polygon, however it is cut, has the area of its border, and all its triangles look to one side: random stars, most
// of them not convex, in a plane that stands anyhow.
TEST(Wavefront, CutsPolygonsThatAreNotConvex) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> part(0, 1);
  for (int k = 0; k < 300; ++k) {
    const int n = 4 + static_cast<int>(engine() % 40);
    const Vector<double, 4> q{{part(engine), part(engine), part(engine) - 0.5, part(engine) + 0.1}};
    const Matrix<double, 3> turn = rotation(Vector<double, 4>(q * (1 / length(q))));
    std::string text, face = "f";
    double twice = 0;
    std::vector<Vector<double, 2>> flat;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.4 * part(engine)) / n, r = 0.2 + part(engine);
      flat.push_back({{r * std::cos(angle), r * std::sin(angle)}});
      const Vector<double, 3> corner = turn * Vector<double, 3>{{flat.back()[0], flat.back()[1], 3}};
      text += line("v", {corner[0], corner[1], corner[2]});
      face += " " + std::to_string(i + 1);
    }
    for (int i = 0; i < n; ++i) {
      const auto &a = flat[static_cast<std::size_t>(i)], &b = flat[static_cast<std::size_t>((i + 1) % n)];
      twice += a[0] * b[1] - a[1] * b[0];
    }
    const TriangleMesh<double> mesh = read(text + face + "\n");
    ASSERT_EQ(mesh.triangles.size(), static_cast<std::size_t>(n - 2));
    const Area found = area(mesh);
    const Vector<double, 3> normal = turn * Vector<double, 3>{{0, 0, 1}};
    EXPECT_NEAR(length(Vector<double, 3>(found.directed - normal * (twice / 2))), 0, 1e-13 * n);
    EXPECT_NEAR(found.sum, twice / 2, 1e-13 * n);
  }
}

// A cube of six squares: its volume by the divergence theorem.
TEST(Wavefront, ACubeHasItsVolume) {
  const TriangleMesh<double> cube = read(
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  double volume = 0;
  for (const auto& [a, b, c] : cube.triangles) volume += dot(cube.corners[a], moment(cube.corners[b], cube.corners[c]));
  EXPECT_EQ(cube.triangles.size(), 12U);
  EXPECT_EQ(volume / 6, 8);
}

// Written from a random mesh to the last digit, and read to the same bits.
TEST(Wavefront, WrittenAndReadToTheSameBits) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> place(-100, 100);
  for (int k = 0; k < 50; ++k) {
    TriangleMesh<double> mesh;
    std::string text;
    for (int i = 0; i < 30; ++i) {
      mesh.corners.push_back({{place(engine), place(engine), place(engine)}});
      const auto& c = mesh.corners.back();
      text += line("v", {c[0], c[1], c[2]});
    }
    for (int i = 0; i < 40; ++i) {
      const auto a = static_cast<std::uint32_t>(engine() % 10), b = static_cast<std::uint32_t>(10 + engine() % 10),
                 c = static_cast<std::uint32_t>(20 + engine() % 10);
      mesh.triangles.push_back({a, b, c});
      text += line("f", {a + 1, b + 1, c + 1});
    }
    EXPECT_EQ(read(text), mesh);
  }
}

TEST(Wavefront, SaysWhatIsWrongAndWhere) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(refusal(""), "m.obj: there are no faces: no lines `f 1 2 3`");
  EXPECT_EQ(refusal(corners), "m.obj: there are no faces: no lines `f 1 2 3`");
  EXPECT_EQ(refusal(corners + "f 1 2 4\n"), "m.obj:4: corner 4 of 3");
  EXPECT_EQ(refusal(corners + "f 1 2 -4\n"), "m.obj:4: corner -4 of 3");
  EXPECT_EQ(refusal(corners + "f 0 1 2\n"),
            "m.obj:4: corners are counted from 1, or from -1 backwards: there is no corner 0");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 zero 0\n"), "m.obj:2: `zero` is no number");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 2\n"), "m.obj:2: a corner needs three numbers, as in v 0 1 2.5");
  EXPECT_EQ(refusal("v 0 0 inf\n"), "m.obj:1: `inf` is not finite");
  EXPECT_EQ(refusal("v 0 nan 0\n"), "m.obj:1: `nan` is not finite");
  EXPECT_EQ(refusal("v 0 1e999 0\n"), "m.obj:1: `1e999` is no number");
  EXPECT_EQ(refusal(corners + "f 1 2\n"), "m.obj:4: a face needs three corners or more");
  EXPECT_EQ(refusal(corners + "\nf 1 1 2\n"), "m.obj:5: this face has no area: leave it out");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 1 1\nv 3 3 3\nf 1 2 3\n"), "m.obj:4: this face has no area: leave it out");
  for (const std::string word : {"a", "1/", "1//", "1/a", "1/2/3/4", "/1", "1.5", "99999999999999999999", "--1"})
    EXPECT_THAT(refusal(corners + "f " + word + " 2 3\n"), testing::StartsWith("m.obj:4: `" + word + "` is no corner"))
        << word;
  // A bow tie, and a square whose corners lie on one line.
  EXPECT_EQ(refusal("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n"),
            "m.obj:5: this face crosses itself, or has no area");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n"),
            "m.obj:5: this face crosses itself, or has no area");
  std::string many;
  for (int i = 0; i < 201; ++i) many += line("v", {std::cos(i / 33.0), std::sin(i / 33.0), 0.0});
  many += "f";
  for (int i = 1; i <= 201; ++i) many += " " + std::to_string(i);
  EXPECT_EQ(refusal(many), "m.obj:202: a face has at most 200 corners");
}

// Bytes by chance, of pieces of such files: read or refused with a place, and what is read has only corners that are
// there.
TEST(Wavefront, AnyBytes) {
  std::mt19937 engine(11);
  const std::vector<std::string> parts = {
      "v ",        "f ",   "1 ", "2 ", "-1 ", "3/1 ", "0 ", "\n",   "\n",        "v 0 0 0\n",          "v 1 0 0\n",
      "v 0 1 0\n", "1e3 ", "#",  "/",  "//",  "\r",   "\t", "nan ", "f 1 2 3\n", std::string(1, '\0'), "\xFF"};
  int good = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string text = k % 2 == 0 ? "" : "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (std::size_t i = engine() % (k % 2 == 0 ? 40 : 8); i > 0; --i) text += parts[engine() % parts.size()];
    const auto mesh = parse_wavefront(text, "m.obj");
    if (!mesh) {
      EXPECT_THAT(mesh.status().place, testing::StartsWith("m.obj"));
      EXPECT_FALSE(mesh.status().message.empty());
      continue;
    }
    ++good;
    ASSERT_FALSE(mesh->triangles.empty());
    for (const auto& triangle : mesh->triangles)
      for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh->corners.size());
  }
  EXPECT_GT(good, 100);
}

}  // namespace
}  // namespace continuo::wavefront_test
