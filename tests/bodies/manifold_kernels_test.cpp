// The solver of manifolds in lanes, against the rows of the same contacts that are swept one by one, and its widths
// against each other.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/rigid_stepping/manifold_solver.hpp>

namespace continuo::manifold_kernels_test {
namespace {

template <class Real, int Dim>
struct Scene {
  std::vector<RigidBody<Real, Dim>> bodies;
  std::vector<PartContact<Real, Dim>> contacts;
  std::vector<std::uint32_t> which;

  [[nodiscard]] std::vector<ContactHead> heads() const {
    std::vector<ContactHead> all;
    for (const PartContact<Real, Dim>& found : contacts) all.push_back(head_of(found));
    return all;
  }
};

class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  template <class Real>
  [[nodiscard]] Real between(double low, double high) {
    return static_cast<Real>(low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0));
  }
  template <class Real, int Size>
  [[nodiscard]] Vector<Real, Size> vector(double most) {
    Vector<Real, Size> v;
    for (Real& part : v.components) part = between<Real>(-most, most);
    return v;
  }
  [[nodiscard]] std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(engine_() % count); }

 private:
  std::mt19937 engine_;
};

/// Moving bodies, of which one in eight is fixed, with random contacts between them.
template <class Real, int Dim>
Scene<Real, Dim> random_scene(unsigned seed, std::size_t bodies, std::size_t contacts) {
  Numbers numbers(seed);
  Scene<Real, Dim> scene;
  for (std::size_t i = 0; i < bodies; ++i) {
    RigidBody<Real, Dim>& body = scene.bodies.emplace_back();
    if (i % 8 == 7) continue;
    body.v = numbers.vector<Real, Dim>(2);
    body.spin = numbers.vector<Real, Spin<Real, Dim>::size()>(2);
    body.inverse_mass = numbers.between<Real>(0.5, 2);
    for (std::size_t k = 0; k < body.inverse_inertia_now.columns.size(); ++k)
      body.inverse_inertia_now[k][k] = numbers.between<Real>(0.5, 2);
  }
  while (scene.contacts.size() < contacts) {
    PartContact<Real, Dim> found;
    found.a = numbers.below(bodies), found.b = numbers.below(bodies);
    const auto &a = scene.bodies[found.a], &b = scene.bodies[found.b];
    if (found.a == found.b || (a.is_fixed() && b.is_fixed())) continue;
    auto& contact = found.contact;
    contact.normal = numbers.vector<Real, Dim>(1);
    contact.normal *= 1 / length(contact.normal);
    contact.normal_in_a = contact.normal, contact.held_axes = identity_matrix<Real, Dim>();
    contact.found_at.centre = numbers.vector<Real, Dim>(1);
    contact.friction = static_cast<Real>(numbers.between<float>(0, 1));  // which rows have in single precision
    contact.size = 1 + numbers.below(contact.points.size());
    for (auto& point : contact.all()) {
      point.arm_a = numbers.vector<Real, Dim>(1), point.arm_b = point.arm_a - contact.found_at.centre;
      point.local_a = point.arm_a, point.local_b = point.arm_b;
      point.separation = numbers.between<Real>(-0.1, 0.02);
      point.impulse = numbers.between<Real>(0, 1);
      point.friction[0] = numbers.between<Real>(-0.2, 0.2);
    }
    scene.which.push_back(static_cast<std::uint32_t>(scene.contacts.size()));
    scene.contacts.push_back(found);
  }
  return scene;
}

/// The velocities after each pass, one after another.
template <class Real, int Dim>
std::vector<Real> solved(Scene<Real, Dim> scene, const ManifoldKernels<Real, Dim>& kernels,
                         const std::vector<ManifoldPass>& passes = {ManifoldPass::begin, ManifoldPass::push,
                                                                    ManifoldPass::relax}) {
  ThreadTeam team(1);
  ManifoldSolver<Real, Dim> solver(team, kernels);
  const auto heads = scene.heads();
  solver.begin(scene.bodies, {.all = scene.contacts, .heads = heads, .separations = {}, .which = scene.which});
  const Real h = Real(1) / 240;
  solver.set_hardness(h, softness(Real(30), Real(10), h), softness(Real(60), Real(10), h), Real(4));
  solver.set_deep(Real(0.05), Real(0.02));  // of separations from -0.1 on
  std::vector<Real> numbers;
  for (const ManifoldPass pass : passes) {
    solver.sweep(pass);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      for (const Real& part : solver.state(i).v().components) numbers.push_back(part);
      for (const Real& part : solver.state(i).spin().components) numbers.push_back(part);
      if (pass != ManifoldPass::push || scene.bodies[i].is_fixed()) continue;
      if constexpr (Dim == 2) {
        move(solver.state(i), solver.state(i).spin(), h, solver.angle(i));
      } else {
        move(solver.state(i), solver.state(i).spin(), h);
      }
    }
  }
  solver.store_impulses(scene.contacts);
  for (const auto& found : scene.contacts)
    for (const auto& point : found.contact.all()) {
      numbers.push_back(point.impulse);
      for (const Real& part : point.friction.components) numbers.push_back(part);
    }
  return numbers;
}

/// `numbers` are those of `solved` with the pass `push_pressed` as the third.
template <class Real, int Dim>
void expect_that_only_what_is_pressed_moves(const Scene<Real, Dim>& scene, const std::vector<Real>& numbers) {
  std::vector<bool> is_pressed(scene.bodies.size());
  for (const auto& found : scene.contacts)
    for (const auto& point : found.contact.all())
      if (point.separation < Real(-0.02)) is_pressed[found.a] = is_pressed[found.b] = true;
  constexpr std::size_t of_body = Vector<Real, Dim>::size() + Spin<Real, Dim>::size();
  const std::size_t of_pass = of_body * scene.bodies.size();
  std::size_t moved = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto after_push = numbers.begin() + static_cast<std::ptrdiff_t>(of_pass + i * of_body);
    const bool moves = !std::equal(after_push, after_push + of_body, after_push + static_cast<std::ptrdiff_t>(of_pass));
    EXPECT_FALSE(moves && !is_pressed[i]) << i;
    moved += moves ? 1 : 0;
  }
  EXPECT_GT(moved, scene.contacts.size() / 10);
}
template <class Real, int Dim>
void expect_the_same_bits_of_all_widths() {
  const auto kernels = manifold_kernels<Real, Dim>();
  const std::vector<ManifoldPass> all = {ManifoldPass::begin, ManifoldPass::push, ManifoldPass::push_pressed,
                                         ManifoldPass::relax, ManifoldPass::relax_deep};
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const auto scene = random_scene<Real, Dim>(seed, 60, seed == 1 ? 7 : 200);
    const auto expected = solved(scene, kernels.front(), all);
    for (const auto& of_width : kernels) EXPECT_EQ(solved(scene, of_width, all), expected) << of_width.lanes;
    expect_that_only_what_is_pressed_moves(scene, expected);
  }
}
TEST(ManifoldKernels, GiveTheSameBitsOfAllWidths) {
  expect_the_same_bits_of_all_widths<double, 2>();
  expect_the_same_bits_of_all_widths<double, 3>();
  expect_the_same_bits_of_all_widths<float, 2>();
  expect_the_same_bits_of_all_widths<float, 3>();
}

/// One contact, so that the order is the same: rows that are swept as in constraint_rows.hpp are the referee.
template <int Dim>
void expect_what_rows_give() {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    Scene<double, Dim> scene = random_scene<double, Dim>(seed, 2, 1);
    const auto found = scene.contacts[0];
    const std::vector<double> numbers = solved(scene, manifold_kernels<double, Dim>().back());
    const double h = 1.0 / 240;
    const bool is_at_fixed = scene.bodies[found.a].is_fixed() || scene.bodies[found.b].is_fixed();
    const Softness<double> soft = softness(is_at_fixed ? 60.0 : 30.0, 10.0, h);
    const ContactHardness<double> hardness{h, soft.rate, soft.of_impulse / soft.of_mass, 4};
    auto &a = scene.bodies[found.a], &b = scene.bodies[found.b];
    std::vector<ConstraintRow<double, Dim>> rows;
    const RowBlock block = add_rows(found.contact, found.a, found.b, a, b, rows);
    std::vector<double> expected;
    const auto note = [&] {
      for (const auto& body : scene.bodies) {
        expected.insert(expected.end(), body.v.components.begin(), body.v.components.end());
        expected.insert(expected.end(), body.spin.components.begin(), body.spin.components.end());
      }
    };
    for (auto& row : rows) row.apply(row.impulse, a, b);
    note();
    aim<double, Dim>(found.contact, rows, a, b, hardness);
    sweep<double, Dim>(rows, block, RowPass::push, a, b);
    note();
    a.move(h), b.move(h), a.axes = rotation(a.orientation), b.axes = rotation(b.orientation);
    aim<double, Dim>(found.contact, rows, a, b, hardness);
    sweep<double, Dim>(rows, block, RowPass::relax, a, b);
    note();
    ASSERT_LE(expected.size(), numbers.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-12) << seed << ' ' << i;
  }
}
TEST(ManifoldKernels, GiveWhatRowsGive) {
  expect_what_rows_give<2>();
  expect_what_rows_give<3>();
}

TEST(ContactColours, ShareNoBodyWithinAColour) {
  Numbers numbers(3);
  std::vector<ColouredContact> contacts;
  for (int k = 0; k < 2000; ++k) {
    // The first body has more contacts than there are colours.
    const std::uint32_t a = k < 100 ? 0 : numbers.below(400), b = 1 + numbers.below(399);
    if (a == b) continue;
    contacts.push_back({a, k % 5 == 0 ? ColouredContact::none : b, static_cast<std::uint8_t>(1 + numbers.below(4))});
  }
  ContactColours colours;
  colours.find(contacts, 400);
  std::vector<int> times(contacts.size());
  for (std::size_t c = 0; c < ContactColours::most; ++c) {
    std::vector<bool> is_used(400);
    std::uint8_t points = 255;
    for (const std::uint32_t k : colours.of(c)) {
      ++times[k];
      EXPECT_LE(contacts[k].points, points);
      points = contacts[k].points;
      for (const std::uint32_t body : {contacts[k].a, contacts[k].b}) {
        if (body == ColouredContact::none || ContactColours::is_shared(c)) continue;
        EXPECT_FALSE(is_used[body]);
        is_used[body] = true;
      }
    }
  }
  EXPECT_EQ(times, std::vector<int>(contacts.size(), 1));
  EXPECT_FALSE(colours.of(ContactColours::most - 1).empty());
}

}  // namespace
}  // namespace continuo::manifold_kernels_test
