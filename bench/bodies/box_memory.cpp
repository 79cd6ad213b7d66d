// Bytes for each box of a world, and of the fast motion beside it, after 100 steps in which the boxes have become a
// heap.
//   box_memory [BOXES...]
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include <malloc.h>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

std::size_t allocated() {
  const auto state = mallinfo2();
  return state.uordblks + state.hblkhd;
}

/// Boxes that nearly touch, a little turned, between walls; each layer is shifted by half a box, so that all of them
/// lean on each other.
template <class Real, int Dim>
void fill(World<Real, Dim>& world, std::size_t boxes) {
  std::mt19937 engine(3);
  const auto random = [&] { return static_cast<Real>(engine()) * Real(0x1p-32) - Real(0.5); };
  const auto row = static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(boxes), 1.0 / Dim) - 1e-9));
  constexpr Real spacing = Real(1.06);
  Vector<Real, Dim> upper;
  for (Real& side : upper.components) side = spacing * (static_cast<Real>(row) + Real(0.5));
  upper[Dim - 1] *= 2;
  require(world.add_container({}, upper));
  world.gravity[Dim - 1] = Real(-9.81);
  world.reserve(boxes);
  for (std::size_t k = 0; k < boxes; ++k) {
    BodyDefinition<Real, Dim> body{.shape = Box<Real, Dim>{}};
    std::size_t rest = k;
    for (std::size_t axis = 0; axis < Dim; ++axis, rest /= row)
      body.position[axis] = spacing * (static_cast<Real>(rest % row) + Real(0.5)) + Real(0.02) * random();
    for (std::size_t axis = 0; axis + 1 < Dim; ++axis)
      if (static_cast<std::size_t>(body.position[Dim - 1] / spacing) % 2 == 1) body.position[axis] += spacing / 2;
    body.orientation[Dim == 2 ? 0 : 3] = Real(0.03) * random();
    require(world.add(body).status());
  }
}

template <class Real, int Dim>
void measure(std::size_t boxes) {
  const std::size_t nothing = allocated();
  World<Real, Dim> world;
  fill(world, boxes);
  const std::size_t built = allocated();
  FastMotion<Real, Dim> motion(world);
  for (int step = 0; step < 100; ++step) require(motion.advance());
  const auto of_each = [&](std::size_t bytes) { return static_cast<double>(bytes) / static_cast<double>(boxes); };
  std::printf("| %zu | %s | %s | %.0f | %.0f | %.0f | %.2f |\n", boxes, Dim == 2 ? "plane" : "space",
              sizeof(Real) == 4 ? "float" : "double", of_each(built - nothing), of_each(allocated() - built),
              of_each(allocated() - nothing), of_each(motion.statistics().contacts));
  std::fflush(stdout);
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  std::puts(
      "| Boxes | In | Numbers | World, bytes a box | Motion | Both | Contacts a box |\n|---|---|---|---|---|---|---|");
  std::vector<std::size_t> sizes;
  for (int k = 1; k < count; ++k) sizes.push_back(std::strtoul(arguments[k], nullptr, 10));
  if (sizes.empty()) sizes = {1'000, 10'000, 100'000};
  for (const std::size_t boxes : sizes) {
    measure<float, 2>(boxes), measure<double, 2>(boxes);
    measure<float, 3>(boxes), measure<double, 3>(boxes);
  }
}
