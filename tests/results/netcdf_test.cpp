// NetCDF files, read back by the netCDF library itself.
#include <cstring>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <netcdf.h>

#include <continuo/language/load.hpp>
#include <continuo/language/world.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::results {
namespace {

using testing::ElementsAre;

class Reading {
 public:
  explicit Reading(const std::string& path) { EXPECT_EQ(nc_open(path.c_str(), NC_NOWRITE, &file_), NC_NOERR); }
  ~Reading() { nc_close(file_); }

  std::vector<std::string> dimensions(const char* variable) const {
    int count = 0;
    EXPECT_EQ(nc_inq_varndims(file_, id(variable), &count), NC_NOERR) << variable;
    std::vector<int> ids(static_cast<std::size_t>(count));
    nc_inq_vardimid(file_, id(variable), ids.data());
    std::vector<std::string> names;
    for (const int dimension : ids) {
      char name[NC_MAX_NAME + 1];
      nc_inq_dimname(file_, dimension, name);
      names.emplace_back(name);
    }
    return names;
  }
  std::size_t size(const char* dimension) const {
    int dim = -1;
    std::size_t size = 0;
    EXPECT_EQ(nc_inq_dimid(file_, dimension, &dim), NC_NOERR);
    nc_inq_dimlen(file_, dim, &size);
    return size;
  }
  std::vector<double> values(const char* variable) const {
    std::size_t count = 1;
    for (const std::string& dimension : dimensions(variable)) count *= size(dimension.c_str());
    std::vector<double> values(count);
    EXPECT_EQ(nc_get_var_double(file_, id(variable), values.data()), NC_NOERR) << variable;
    return values;
  }
  std::vector<std::string> texts(const char* variable) const {
    const std::size_t longest = size(("letters_of_" + std::string(variable)).c_str());
    std::vector<char> letters(size(variable) * longest + 1);
    EXPECT_EQ(nc_get_var_text(file_, id(variable), letters.data()), NC_NOERR) << variable;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < size(variable); ++i) {
      const std::string text(letters.data() + i * longest, longest);
      texts.push_back(text.substr(0, text.find('\0')));
    }
    return texts;
  }
  std::string attribute(const char* variable, const char* name) const {
    std::size_t size = 0;
    const int of = std::strlen(variable) == 0 ? NC_GLOBAL : id(variable);
    if (nc_inq_attlen(file_, of, name, &size) != NC_NOERR) return "none";
    std::string text(size, '\0');
    nc_get_att_text(file_, of, name, text.data());
    return text;
  }

 private:
  int id(const char* variable) const {
    int id = -1;
    EXPECT_EQ(nc_inq_varid(file_, variable, &id), NC_NOERR) << variable;
    return id;
  }
  int file_ = -1;
};

std::string scratch(const char* name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
}

model::Model model_of(const char* text) {
  model::Loaded loaded = model::load(model::Source("model.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return std::move(loaded.model).value();
}

TEST(NetCdf, HoldsOneVariableForEachColumnOfEquations) {
  const model::Model model = model_of(R"(# A spring.
model Spring
param k = 4 [N/m], m = 1 [kg]
x'' = -k/m*x
x(0) = 5 [m]; x'(0) = 0 [m/s]
output twice = 2*x
energy elastic = 1/2*k*x^2, kinetic = 1/2*m*x'^2
run 0..1 [s] output 0.25
)");
  const model::Simulated simulated = simulate(model);
  const std::string path = scratch("spring.nc");
  ASSERT_TRUE(write_netcdf(model, *simulated.run, path, "a hash"));
  const Reading file(path);
  EXPECT_THAT(file.values("time"), ElementsAre(0, 0.25, 0.5, 0.75, 1));
  EXPECT_EQ(file.attribute("time", "units"), "s");
  EXPECT_THAT(file.dimensions("x'"), ElementsAre("time"));
  EXPECT_EQ(file.attribute("x'", "units"), "m/s");
  for (std::size_t row = 0; row < 5; ++row) {
    EXPECT_EQ(file.values("x")[row], simulated.run->motion.row(row)[1]);
    EXPECT_EQ(file.values("twice")[row], 2 * file.values("x")[row]);
    EXPECT_EQ(file.values("energy")[row], simulated.run->total_energy[row]);
  }
  EXPECT_EQ(file.attribute("energy", "units"), "J");
  EXPECT_EQ(file.attribute("", "title"), "Spring");
  EXPECT_EQ(file.attribute("", "comment"), "A spring.");
  EXPECT_EQ(file.attribute("", "manifest"), "a hash");
  EXPECT_EQ(file.attribute("", "Conventions"), "CF-1.8");
  std::filesystem::remove(path);
}

/// Rows made by hand: state k of body b at row r is 100 r + 10 b + k.
TEST(NetCdf, HoldsBodiesByTimeBodyAndComponent) {
  for (const int dimension : {2, 3}) {
    const bool plane = dimension == 2;
    const model::Model model =
        model_of(plane ? "world { body a at (0, 0) [m] radius 2 mass 3; bodies b grid 2 from (9, 0) spacing (5, 0) }\n"
                         "y' = 1\ny(0) = 0\noutput position = y\nrun 0..1 [s]\n"
                       : "world { dimension 3; body a at (0, 0, 0) radius 2 mass 3\n"
                         "bodies b grid 2 from (9, 0, 0) spacing (5, 0, 0) }\n"
                         "y' = 1\ny(0) = 0\noutput position = y\nrun 0..1\n");
    const std::size_t per_body = model::WorldDescription::states_of_body(dimension);
    model::Run run;
    run.plan.variables = start_values(model);
    run.motion.states = model.states.size();
    run.motion.columns = {{"t", "s"}};
    for (const model::State& state : model.states) run.motion.columns.push_back({state.column, state.unit});
    run.motion.columns.push_back({"position", ""});
    for (std::size_t row = 0; row < 2; ++row) {
      run.motion.values.push_back(static_cast<double>(row));
      for (std::size_t k = 0; k < model.states.size(); ++k)
        run.motion.values.push_back(static_cast<double>(100 * row + 10 * (k / per_body) + k % per_body));
      run.motion.values.push_back(7);
    }
    const std::string path = scratch("bodies.nc");
    ASSERT_TRUE(write_netcdf(model, run, path, ""));
    const Reading file(path);
    EXPECT_THAT(file.texts("body"), ElementsAre("a", "b[1]", "b[2]"));
    EXPECT_THAT(file.dimensions("position"), ElementsAre("time", "body", "component"));
    EXPECT_THAT(file.dimensions("velocity"), ElementsAre("time", "body", "component"));
    EXPECT_THAT(file.values("mass")[0], 3);
    EXPECT_THAT(file.values("radius"), ElementsAre(2, 0.5, 0.5));
    EXPECT_THAT(file.values("position_"), ElementsAre(7, 7));  // the output of that name
    EXPECT_THAT(file.dimensions("world.kinetic"), ElementsAre("time"));
    if (plane) {
      EXPECT_THAT(file.texts("component"), ElementsAre("x", "y"));
      EXPECT_THAT(file.values("position"), ElementsAre(0, 2, 10, 12, 20, 22, 100, 102, 110, 112, 120, 122));
      EXPECT_THAT(file.values("velocity"), ElementsAre(1, 3, 11, 13, 21, 23, 101, 103, 111, 113, 121, 123));
      EXPECT_THAT(file.values("angle"), ElementsAre(4, 14, 24, 104, 114, 124));
      EXPECT_EQ(file.attribute("position", "units"), "m");
      EXPECT_EQ(file.attribute("velocity", "units"), "m/s");
    } else {
      EXPECT_THAT(file.texts("component"), ElementsAre("x", "y", "z"));
      EXPECT_THAT(file.values("position"),
                  ElementsAre(0, 2, 4, 10, 12, 14, 20, 22, 24, 100, 102, 104, 110, 112, 114, 120, 122, 124));
      EXPECT_THAT(file.texts("part"), ElementsAre("w", "x", "y", "z"));
      EXPECT_THAT(file.dimensions("orientation"), ElementsAre("time", "body", "part"));
      EXPECT_THAT(file.values("orientation")[23], 129);
      EXPECT_THAT(file.values("spin")[17], 132);
      EXPECT_EQ(file.attribute("position", "units"), "none");
    }
    std::filesystem::remove(path);
  }
}

TEST(NetCdf, MakesAnArrayOfAFamily) {
  const model::Model model = model_of(
      "for i in 2..4 { u[i]'' = -i*u[i]\nu[i](0) = i\nu[i]'(0) = 0 }\n"
      "for i in 1..2 { for j in 0..1 { w[i, j]' = 10*i + j\nw[i, j](0) = 0 } }\n"
      "for k in 2..4 { output twice[k] = 2*u[k] }\noutput one = u[2]\noutput i = 5\nrun 0..1 output 0.5\n");
  const model::Simulated simulated = simulate(model);
  ASSERT_TRUE(simulated.run);
  const std::string path = scratch("families.nc");
  ASSERT_TRUE(write_netcdf(model, *simulated.run, path, ""));
  const Reading file(path);
  EXPECT_THAT(file.dimensions("u"), ElementsAre("time", "i"));
  EXPECT_THAT(file.dimensions("u'"), ElementsAre("time", "i"));
  EXPECT_THAT(file.dimensions("twice"), ElementsAre("time", "i"));  // of the same indices
  EXPECT_THAT(file.dimensions("w"), ElementsAre("time", "j", "k"));
  EXPECT_THAT(file.dimensions("one"), ElementsAre("time"));
  EXPECT_THAT(file.dimensions("i_"), ElementsAre("time"));  // the output of that name
  EXPECT_THAT(file.values("i"), ElementsAre(2, 3, 4));
  EXPECT_THAT(file.values("k"), ElementsAre(0, 1));
  const auto u = file.values("u"), twice = file.values("twice"), w = file.values("w");
  ASSERT_EQ(u.size(), 9u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(u[k], static_cast<double>(k + 2));
  for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(twice[k], 2 * u[k]);
  ASSERT_EQ(w.size(), 12u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(w[8 + k], static_cast<double>(10 + 10 * (k / 2) + k % 2), 1e-12);
  std::filesystem::remove(path);
}

TEST(NetCdf, SaysWhyItCannotBeWritten) {
  const model::Model model = model_of("x' = 1\nx(0) = 0\nrun 0..1\n");
  const model::Simulated simulated = simulate(model);
  const Status status = write_netcdf(model, *simulated.run, "/nowhere/at/all.nc", "");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.ending, Ending::unwritable);
  EXPECT_THAT(status.message, testing::StartsWith("cannot write /nowhere/at/all.nc: "));
}

}  // namespace
}  // namespace continuo::results
