// Meshes and chains in the language: held against closed forms, walls, and the same world built by hand.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>
#include <unistd.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/language/load.hpp>
#include <continuo/status/require.hpp>
#include <continuo/worlds/build_world.hpp>

namespace continuo::worlds::meshes_test {
namespace {

const WorldOptions fast{.method = "fast", .step = 1.0 / 240};

/// A folder for the files of a model, which is gone at the end.
class Meshes : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(::testing::TempDir()) / fmt::format("continuo-meshes-{}", ::getpid());
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  std::shared_ptr<const model::ModelProgram> program(const std::string& text) const {
    model::Loaded loaded = model::load(model::Source((folder / "scene.sim").string(), text));
    EXPECT_TRUE(loaded) << loaded.text();
    return loaded ? model::compile(std::move(*loaded.model)) : nullptr;
  }
  std::unique_ptr<WorldRun> run(const std::string& text) const {
    const auto of = program(text);
    auto world = start_world(of, fast, start_values(of->model));
    EXPECT_TRUE(world) << world.status().message;
    return world ? *std::move(world) : nullptr;
  }

  std::filesystem::path folder;
};

// Hills over a grid, and boxes and balls above them at random: the same bits as the world built by hand.
TEST_F(Meshes, AMeshMovesBodiesAsTheWorldBuiltByHandDoes) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int k = 0; k < 6; ++k) {
    TriangleMesh<double> hills;
    std::string file;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        hills.corners.push_back({{2.0 * i - 5, 2.0 * j - 5, 0.5 * part(random)}});
        const auto& c = hills.corners.back();
        file += fmt::format("v {} {} {}\n", c[0], c[1], c[2]);
      }
    for (std::uint32_t j = 0; j < 5; ++j)
      for (std::uint32_t i = 0; i < 5; ++i) {
        const std::uint32_t a = 6 * j + i;
        hills.triangles.push_back({a, a + 1, a + 7});
        hills.triangles.push_back({a, a + 7, a + 6});
        file += fmt::format("f {} {} {} {}\n", a + 1, a + 2, a + 8, a + 7);
      }
    write("hills.obj", file);
    std::string text =
        "world {\n dimension 3\n gravity (0, 0, -10)\n mode fast step 1/240\n"
        " wall hills mesh \"hills.obj\" friction 0.6 restitution 0.2\n";
    World<double, 3> world;
    world.gravity = {{0, 0, -10}};
    for (int i = 0; i < 8; ++i) {
      const Vector<double, 3> at{{2 * part(random), 2 * part(random), 2.0 + i}};
      const bool is_box = i % 2 == 0;
      BodyDefinition<double, 3> body{.shape = Sphere<double>{0.4}, .position = at, .mass = 2};
      if (is_box) body.shape = Box<double, 3>{{{0.6, 0.7, 0.8}}, 0};
      body.material = {.restitution = 0, .friction = 0.5};
      require(world.add(body));
      text += fmt::format(" body b{} at ({}, {}, {}) {} mass 2\n", i, at[0], at[1], at[2],
                          is_box ? "box (0.6, 0.7, 0.8)" : "radius 0.4");
    }
    require(world.add_mesh({.shape = hills, .material = {.restitution = 0.2, .friction = 0.6}}));
    FastMotion<double, 3> motion(world, {.step = 1.0 / 240, .substeps = 4});
    const auto described = run(text + "}\nrun 0..2\n");
    while (world.time < 2) {
      require(motion.advance());
      ASSERT_TRUE(described->advance_to(world.time));
    }
    for (std::size_t i = 0; i < world.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(described->position(i)[axis], world.position[i][axis]) << k << " " << i;
        EXPECT_EQ(described->velocity(i)[axis], world.velocity[i][axis]) << k << " " << i;
      }
    EXPECT_GT(world.position[0][2], -1);  // it is not through
  }
}

// A box that slides on two triangles, and on a wall in the same plane: one motion, but for the order of contacts.
TEST_F(Meshes, ABoxOnTwoTrianglesSlidesAsOnAWall) {
  write("plane.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
  const std::string head = "world { dimension 3\n gravity (0, 0, -10)\n mode fast step 1/240\n";
  const std::string tail =
      "\n body box at (-1, 0.3, 0.5) box (1, 1, 1) velocity (3, 0, 0)\n body ball at (4, 2, 1) radius 0.5 }\n"
      "run 0..1\n";
  const auto on_wall = run(head + " wall ground (0, 0, 1) at 0" + tail);
  const auto on_mesh = run(head + " wall ground mesh \"plane.obj\"" + tail);
  ASSERT_TRUE(on_wall->advance_to(1));
  ASSERT_TRUE(on_mesh->advance_to(1));
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(on_mesh->position(i)[axis], on_wall->position(i)[axis], 1e-3) << i << axis;
  EXPECT_NEAR(on_mesh->position(0)[0], -1 + 9.0 / 2 / 5, 5e-3);  // v^2/(2 mu g), mu = 0.5
  ASSERT_EQ(on_mesh->meshes().size(), 1U);
  EXPECT_EQ(on_mesh->meshes()[0].facets.size(), 2U);
}

/// The corners of each facet of a mesh, one after the other.
std::vector<double> corners_of(const StaticMesh<double, 3>& mesh) {
  std::vector<double> all;
  for (std::uint32_t facet = 0; facet < mesh.size(); ++facet)
    for (const std::uint32_t number : mesh.numbers(facet))
      for (const double component : mesh.corner(number).components) all.push_back(component);
  return all;
}
std::vector<double> corners_of(const model::Model& model) {
  const auto built = build_world<3>(model, start_values(model));
  EXPECT_TRUE(built.status) << built.status.message;
  return corners_of(*built.world.meshes()[0].geometry);
}

// The facets of a HeightField of shapes/, in its order: from an expression, and from a file with its lines shuffled,
// whose heights are in centimetres.
TEST_F(Meshes, HeightsAreTheTrianglesOfAHeightField) {
  std::mt19937_64 random(4);
  for (const auto& [width, depth] : {std::pair(2, 2), {5, 3}, {3, 7}, {9, 8}}) {
    HeightField<double, 3> field{.origin = {{-4, 1.5, 0}},
                                 .spacing = {0.5, 1.25},
                                 .counts = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(depth)}};
    std::vector<std::string> lines;
    for (int j = 0; j < depth; ++j)
      for (int i = 0; i < width; ++i) {
        field.heights.push_back((i + 2) * 0.25 - j * j * 0.125);
        lines.push_back(fmt::format("{},{},{}\n", field.origin[0] + 0.5 * i, field.origin[1] + 1.25 * j,
                                    100 * field.heights.back()));
      }
    World<double, 3> world;
    require(world.add_mesh({.shape = field}));
    const std::vector<double> expected = corners_of(*world.meshes()[0].geometry);
    std::ranges::shuffle(lines, random);
    std::string file = "x,y,z [cm]\n";
    for (const std::string& line : lines) file += line;
    write("hills.csv", file);
    const std::string end = "\n body ball at (0, 0, 99) [m] }\nrun 0..1 [s]\n";
    for (const std::string& heights :
         {fmt::format("for i in 2..{}, j in 0..{} {{ i*0.25 - j^2*0.125 }} from (-4, 1.5) spacing (0.5, 1.25)",
                      width + 1, depth - 1),
          std::string("\"hills.csv\"")}) {
      const auto of = program("world { dimension 3\n mode fast step 1/60\n wall hills heights " + heights + end);
      EXPECT_EQ(corners_of(of->model), expected) << heights << " " << width;
    }
  }
}

// Placed as a mesh: scaled, turned about the vertical by a right angle, and moved; parameters move them in a run.
TEST_F(Meshes, HeightsFollowTheirParameters) {
  const auto text = [](const std::string& more) {
    return "param steep = 0.5, apart = 1\nworld { dimension 3\n gravity (0, 0, -10)\n mode fast step 1/60\n"
           " wall slope heights for i in 0..2, j in 0..1 { steep*i*apart } spacing (apart, 2) " +
           more + "\n body ball at (1, 1, 9) }\nrun 0..1\n";
  };
  const auto plain = run(text("")), placed = run(text("at (1, 2, 3) axis (0, 0, 1) angle 90 [deg] scale 2"));
  const auto before = plain->meshes()[0].corners, after = placed->meshes()[0].corners;
  ASSERT_EQ(before.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(after[i][0], 1 - 2 * before[i][1], 1e-14);
    EXPECT_NEAR(after[i][1], 2 + 2 * before[i][0], 1e-14);
    EXPECT_NEAR(after[i][2], 3 + 2 * before[i][2], 1e-14);
  }
  ASSERT_TRUE(plain->set(program(text(""))->model.parameters[1].variable, 3));
  EXPECT_EQ(plain->meshes()[0].corners[5], (Point{6, 2, 3}));
}

// A crate on a slope without friction: its acceleration is that of an inclined plane, on rows of triangles.
TEST_F(Meshes, ABoxSlidesDownHeightsAsDownAPlane) {
  const auto down =
      run("world { dimension 3\n gravity (0, 0, -10)\n mode fast step 1/480\n material friction 0 restitution 0\n"
          " wall slope heights for i in 0..40, j in 0..20 { -0.75*i/4 } from (-5, -2.5) spacing (0.25, 0.25)\n"
          " body crate at (-3.7, 0.1, -0.575) box (0.5, 0.5, 0.5) axis (0, 1, 0) angle atan(0.75) }\nrun 0..1\n");
  ASSERT_TRUE(down->advance_to(1));
  const Point v = down->velocity(0);
  EXPECT_NEAR(v[0], 10 * 0.6 * 0.8, 0.02);
  EXPECT_NEAR(v[2], -10 * 0.6 * 0.6, 0.02);
  EXPECT_NEAR(v[1], 0, 1e-3);
}

TEST_F(Meshes, WrongHeightsAreSaidWithTheirPlace) {
  const auto said = [&](const std::string& heights, const std::string& dimension = "3") {
    const model::Loaded loaded = model::load(
        model::Source((folder / "scene.sim").string(),
                      "world { dimension " + dimension + "\n mode fast step 1/60\n wall hills heights " + heights +
                          "\n body ball at " + (dimension == "3" ? "(0, 0, 9)" : "(0, 9)") + " [m] }\nrun 0..1 [s]\n"));
    EXPECT_FALSE(loaded);
    return loaded.text();
  };
  const auto of_file = [&](const std::string& text) {
    write("hills.csv", text);
    return said("\"hills.csv\"");
  };
  using testing::HasSubstr;
  EXPECT_THAT(of_file("x,y,z\n0,0,1\n1,0,1\n0,1,1\n"), HasSubstr("it has no point at x = 1, y = 1"));
  EXPECT_THAT(of_file("x,y,z\n0,0,1\n1,0,1\n0,1,1\n1,1,0\n0,1,2\n"), HasSubstr("it has two points at x = 0, y = 1"));
  EXPECT_THAT(
      of_file("x,y,z\n0,0,1\n1,0,1\n3,0,1\n0,1,1\n1,1,0\n3,1,2\n"),
      HasSubstr("the x of its points are not evenly apart: 0 and 1 follow each other, and on average they are 1.5 "
                "apart"));
  EXPECT_THAT(of_file("x,y,z\n0,0,1\n1,0,1\n"), HasSubstr("all 2 points have y = 0"));
  EXPECT_THAT(of_file("x,y,z\n0,0,1\n1,0,high\n"), HasSubstr("hills.csv:3"));
  EXPECT_THAT(of_file("x,y,z\n0,0,1\n1,0\n"), HasSubstr("hills.csv:3"));
  EXPECT_THAT(of_file("x,y,z\n0,0,1\n1,0,nan\n"), HasSubstr("hills.csv:3"));
  EXPECT_THAT(of_file("x,y\n0,0\n"), HasSubstr("no column `z`"));
  EXPECT_THAT(of_file("1\n2\n"), HasSubstr("`x`, `y`, `z`"));
  EXPECT_THAT(of_file(""), HasSubstr("E272"));
  EXPECT_THAT(of_file("x,y,z [s]\n0,0,1\n"), HasSubstr("the column `z` is in s, a length is m"));
  EXPECT_THAT(of_file("x,y,z\n-1e308,0,1\n1e308,0,1\n0,1,1\n"), HasSubstr("E272"));
  std::string line = "x,y,z\n";
  for (int i = 0; i < 1100; ++i) line += fmt::format("{},{},0\n", i, i);
  EXPECT_THAT(of_file(line), HasSubstr("a grid of 1100 x 1100 points has more than 1000000 triangles"));
  EXPECT_THAT(said("\"nowhere.csv\""), HasSubstr("E270"));
  EXPECT_THAT(said("\"hills.csv\" from (0, 0)"), HasSubstr("leave `from` out"));
  EXPECT_THAT(said("for i in 0..4, j in 0..4 { i*j }"), HasSubstr("add spacing (1, 1)"));
  EXPECT_THAT(said("for i in 0..0, j in 0..4 { i*j } spacing (1, 1)"), HasSubstr("here is 1"));
  EXPECT_THAT(said("for i in 4..0, j in 0..4 { i*j } spacing (1, 1)"), HasSubstr("error["));
  EXPECT_THAT(said("for i in 0..4, j in 0..4 { i*j } spacing (1, 0)"), HasSubstr("must be greater than 0"));
  EXPECT_THAT(said("for i in 0..4, j in 0..4 { i*j } spacing 1"), HasSubstr("expected a point"));
  EXPECT_THAT(said("for i in 0..4, j in 0..4 { i*j*t } spacing (1, 1)"), HasSubstr("scene.sim:3:"));
  EXPECT_THAT(said("for i in 0..4, j in 0..4 { 1/(i - 2) } spacing (1, 1)"), HasSubstr("must be a finite number"));
  EXPECT_THAT(said("for i in 0..4 { i } spacing (1, 1)"), HasSubstr("a second index"));
  EXPECT_THAT(said("for i in 0..4, j in 0..4 { i*k } spacing (1, 1)"), HasSubstr("there is no `k`"));
  EXPECT_THAT(said("for i in 0..3000, j in 0..3000 { i*j } spacing (1, 1)"), HasSubstr("error["));
  EXPECT_THAT(said("\"hills.csv\"", "2"), HasSubstr("heights over a grid are ground of space"));
}

// `at`, `axis`, `angle` and `scale` place a mesh: the corners are those of the formula a + s R c.
TEST_F(Meshes, AMeshIsScaledTurnedAndMoved) {
  write("one.obj", "v 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\n");
  const auto turned =
      run("param s = 2\nworld { dimension 3\n mode fast step 1/60\n"
          " wall one mesh \"one.obj\" at (1, 2, 3) axis (0, 0, 5) angle 90 [deg] scale s\n"
          " body ball at (9, 9, 9) }\nrun 0..1\n");
  const auto& corners = turned->meshes()[0].corners;  // (x, y) becomes (-y, x)
  const std::vector<Point> expected = {{1, 4, 3}, {-3, 2, 3}, {1, 2, 9}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(corners[i][axis], expected[i][axis], 1e-15);
}

// A disc that rolls down a slope without sliding: 2/3 g sin(a) along it; without friction g sin(a). The chain is
// written from left to right, so that what is above is free.
TEST_F(Meshes, ADiscRollsDownAChainAsInTheTextbook) {
  for (const auto& [friction, share] : {std::pair(0.8, 2.0 / 3), std::pair(0.0, 1.0)}) {
    const double slope = 0.3;
    const auto rolls = run(
        fmt::format("param a = {0}\nworld {{ gravity (0, -10)\n mode fast step 1/240\n material friction {1}\n"
                    " wall slope chain (-30*cos(a), 30*sin(a)) (-10*cos(a), 10*sin(a)) (0, 0) (30*cos(a), -30*sin(a))\n"
                    " body disc at (-5*cos(a) + 0.5*sin(a), 5*sin(a) + 0.5*cos(a)) }}\nrun 0..2\n",
                    slope, friction));
    const Point begin = rolls->position(0);
    ASSERT_TRUE(rolls->advance_to(2));
    const Point end = rolls->position(0);
    const double way = (end[0] - begin[0]) * std::cos(slope) - (end[1] - begin[1]) * std::sin(slope);
    const double expected = share * 10 * std::sin(slope) * 2;  // a t^2/2
    EXPECT_NEAR(way, expected, 0.01 * expected) << friction;
    EXPECT_NEAR(rolls->velocity(0)[0], expected * std::cos(slope), 0.01 * expected);  // v = a t, and t = 2
  }
}

// A disc slides in a parabola y = x^2/4 without friction: at the bottom v^2 = 2 g times the fall of its centre, which
// moves on the parallel curve. At each corner of the chain it loses the part sin^2 of the turn: in all
// 200*(pi/4/200)^2.
TEST_F(Meshes, ADiscSlidesThroughAParabola) {
  const auto slides =
      run("world { gravity (0, -10)\n mode fast step 1/960\n material friction 0 restitution 0\n"
          " wall bowl chain for k in -200..200 { (k/100, k^2/40000) }\n"
          " body disc at (-2 + 0.2*sin(pi/4), 1 + 0.2*cos(pi/4)) radius 0.2 }\nrun 0..2\n");
  const double fall = slides->position(0)[1] - 0.2;
  double fastest = 0;
  for (int k = 1; slides->position(0)[0] < 0.05 && k < 2000; ++k) {
    ASSERT_TRUE(slides->advance_to(k / 960.0));
    fastest = std::max(fastest, std::hypot(slides->velocity(0)[0], slides->velocity(0)[1]));
  }
  EXPECT_NEAR(fastest * fastest / 2, 10 * fall, 0.01 * 10 * fall);
}

// The points of a table, and a family of points, are those of the text.
TEST_F(Meshes, ChainsOfFilesFamiliesAndPointsAreOne) {
  write("profile.csv", "station,y [cm],x [m]\n1,0,-2\n2,0,0\n3,25,1\n4,100,2\n");
  const std::string head = "param n = 2\nworld { mode fast step 1/60\n body b at (0, 5) [m]\n wall ground chain ";
  const auto points = run(head + "(-2, 0) (0, 0)\n\n  (1, 0.25) # on\n (2, 1) [m] }\nrun 0..1\n");
  const auto table = run(head + "from \"profile.csv\" }\nrun 0..1\n");
  const auto family =
      run(head + "for k in -1..n { (if k < 0 then -2 else k, if k < 0 then 0 else k^2/4) [m] } }\nrun 0..1\n");
  for (const auto* other : {&table, &family}) {
    EXPECT_EQ((*other)->meshes()[0].facets, points->meshes()[0].facets);
    EXPECT_EQ((*other)->meshes()[0].corners, points->meshes()[0].corners);
  }
  EXPECT_EQ(points->meshes()[0].corners.front(), (Point{2, 1, 0}));
}

// A closed chain in the order of the clock is an obstacle, against it a room. A thin one is both.
TEST_F(Meshes, TheLeftOfTheWayIsFree) {
  const std::string head = "world { gravity (0, -10)\n mode fast step 1/240\n material restitution 0\n";
  const auto room =
      run(head + " wall room chain (-2, 0) (2, 0) (2, 4) (-2, 4) closed\n body b at (0, 2) }\nrun 0..3\n");
  ASSERT_TRUE(room->advance_to(3));
  EXPECT_NEAR(room->position(0)[1], 0.5, 1e-3);
  const auto block =
      run(head + " wall block chain (-2, 4) (2, 4) (2, 0) (-2, 0) closed\n body b at (0, 6) }\nrun 0..3\n");
  ASSERT_TRUE(block->advance_to(3));
  EXPECT_NEAR(block->position(0)[1], 4.5, 1e-3);
  const auto thin = run(head + " wall shelf chain (2, 0) (-2, 0) thin\n body b at (0, 2) }\nrun 0..3\n");
  ASSERT_TRUE(thin->advance_to(3));
  EXPECT_NEAR(thin->position(0)[1], 0.5, 1e-3);
}

TEST_F(Meshes, ImpactsHaveTheNamesOfBoth) {
  const auto falls = program(
      "world { gravity (0, -10)\n mode fast step 1/240\n wall low (0, 1) at -5\n wall track chain (-1, 0) (1, 0)\n"
      " body a at (0, 1)\n body b at (4, 0.5) }\nrun 0..2\ncheck count of \"a meets track\" = 1\n"
      "check count of \"b meets low\" = 1\ncheck count of \"b meets track\" = 0\n");
  const model::Simulated simulated = simulate_world(falls, {});
  ASSERT_TRUE(simulated.run);
  EXPECT_EQ(failed_checks(*simulated.run), "");
}

// A parameter moves the ground while it runs, and a state that was kept goes on to the same bits.
TEST_F(Meshes, ParametersMoveTheGroundAndSnapshotsKeepIt) {
  const std::string text =
      "param h = 0\nworld { gravity (0, -10)\n mode fast step 1/240\n material restitution 0\n"
      " wall track chain (-1, h) (1, h)\n body a at (0, 2) }\nrun 0..9\n";
  const auto falls = run(text);
  ASSERT_TRUE(falls->advance_to(2));
  EXPECT_NEAR(falls->position(0)[1], 0.5, 1e-3);
  const auto of = program(text);
  ASSERT_TRUE(falls->set(of->model.parameters[0].variable, -3));
  EXPECT_EQ(falls->meshes()[0].corners[0][1], -3);
  const Snapshot kept = falls->snapshot();
  ASSERT_TRUE(falls->advance_to(4));
  EXPECT_NEAR(falls->position(0)[1], -2.5, 1e-3);
  const auto again = run(text);
  ASSERT_TRUE(again->check(kept));
  ASSERT_TRUE(again->restore(kept));
  EXPECT_EQ(again->meshes()[0].corners[0][1], -3);
  ASSERT_TRUE(again->advance_to(4));
  EXPECT_EQ(again->position(0)[1], falls->position(0)[1]);
  EXPECT_FALSE(run("world { mode fast step 1/240\n body a at (0, 2) box (1, 1) }\nrun 0..9\n")->check(kept));
  ASSERT_FALSE(falls->set(of->model.parameters[0].variable, std::nan("")));  // refused, and as it was
  EXPECT_EQ(falls->meshes()[0].corners[0][1], -3);
}

// Rays of the language, written out facet by facet, against the search in the world's own trees: at the same distance,
// or past it, on random meshes that stand anyhow, free on one side or on both.
template <int Dim>
void rays_meet_what_the_search_finds(const std::filesystem::path& folder, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  std::string file, points, text;
  for (int i = 0; i < 12; ++i) {
    file += fmt::format("v {} {} {}\n", 3 * part(random), 3 * part(random), 3 * part(random));
    points += fmt::format(" ({}, {})", 3 * part(random), 3 * part(random));
  }
  for (int i = 0; i < 20; ++i)
    file += fmt::format("f {} {} {}\n", 1 + random() % 4, 5 + random() % 4, 9 + random() % 4);
  std::ofstream(folder / "rays.obj") << file;
  const std::string more = seed % 2 == 0 ? " thin" : "";
  text = fmt::format("world {{ dimension {}\n mode fast step 1/60\n", Dim);
  text += Dim == 2 ? " wall w chain" + points + fmt::format(" at (0.1, 0.2) angle {} scale 1.5", part(random)) + more
                   : fmt::format(" wall w mesh \"rays.obj\" at (0.1, 0, 0.3) angle ({}, {}, 1) scale 1.5", part(random),
                                 part(random)) +
                         more;
  text += Dim == 2 ? "\n body b at (50, 50) }\n" : "\n body b at (50, 50, 50) }\n";
  std::vector<Ray<double, Dim>> rays;
  for (int k = 0; k < 60; ++k) {
    Ray<double, Dim>& ray = rays.emplace_back();
    std::string from, towards;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      ray.origin[axis] = 6 * part(random), ray.direction[axis] = part(random) - ray.origin[axis] / 3;
      from += fmt::format("{}{}", axis > 0 ? ", " : "", ray.origin[axis]);
      towards += fmt::format("{}{}", axis > 0 ? ", " : "", ray.direction[axis]);
    }
    ray.reach = 20;
    text += fmt::format("output way{} = ray(({}), ({}), 20, w)\n", k, from, towards);
  }
  model::Loaded loaded = model::load(model::Source((folder / "scene.sim").string(), text + "run 0..1\n"));
  ASSERT_TRUE(loaded) << loaded.text();
  const std::vector<double> start = start_values(*loaded.model);
  const auto built = build_world<Dim>(*loaded.model, start);
  ASSERT_TRUE(built.status) << built.status.message;
  const Queries<double, Dim> queries(built.world);
  int hits = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto found = queries.first_hit(rays[k]);
    ASSERT_TRUE(found);
    const double way = evaluate(*loaded.model, loaded.model->outputs[k].node, start);
    EXPECT_NEAR(way, found->empty() ? 20 : found->front().distance, 1e-10) << Dim << " " << seed << " " << k;
    hits += found->empty() ? 0 : 1;
  }
  EXPECT_GT(hits, 5);
}

TEST_F(Meshes, RaysMeetWhatTheSearchFinds) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    rays_meet_what_the_search_finds<2>(folder, seed);
    rays_meet_what_the_search_finds<3>(folder, seed);
  }
}

}  // namespace
}  // namespace continuo::worlds::meshes_test
