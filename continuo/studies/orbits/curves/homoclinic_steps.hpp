// One place after the other on a curve of homoclinic orbits. Internal to homoclinic_curve.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <continuo/status/result.hpp>
#include <continuo/studies/orbit_curve.hpp>
#include <continuo/studies/orbits/curves/homoclinic_orbit.hpp>
#include <continuo/studies/orbits/curves/saddle_node.hpp>

namespace continuo::studies::detail {

/// HomCont's test functions psi. `neutral`: 1 and 4; `divergent_stable`, `divergent_unstable`: 5 and 6; `double_*`: 2
/// and 3; `triple_*`: 7 and 8; `rest_stable`, `rest_unstable`: 9 and 10; `orbit_flip_*`: 11 and 12;
/// `inclination_flip_*`: 13 and 14. Of central orbits `leaves_centre` and `comes_by_centre`: 15 and 16, the centre's
/// part of the first and the last state, both positive; `curvature`: that of the centre.
enum class HomoclinicTest {
  neutral,
  divergent_stable,
  divergent_unstable,
  double_stable,
  double_unstable,
  triple_stable,
  triple_unstable,
  rest_stable,
  rest_unstable,
  orbit_flip_stable,
  orbit_flip_unstable,
  inclination_flip_stable,
  inclination_flip_unstable,
  leaves_centre,
  comes_by_centre,
  curvature
};
inline constexpr std::size_t homoclinic_tests = 16;

struct HomoclinicPlace {
  std::shared_ptr<const OrbitMesh> mesh{};
  double length = 0;
  std::vector<double> z{};        // the unknowns of HomoclinicOrbit
  std::vector<double> tangent{};  // of length 1, in sizes
  OrbitCurvePoint point{};
  HomoclinicRest rest{};
  SaddleSpaces spaces{};
  double error = 0;        // of the collocation inside of an interval, in sizes
  double apart_first = 0;  // how far both ends are from the saddle, in sizes
  double apart_last = 0;
  /// Each changes its sign where it is zero. Not a number where it says nothing.
  std::array<double, homoclinic_tests> tests{};
  [[nodiscard]] double test(HomoclinicTest kind) const { return tests[static_cast<std::size_t>(kind)]; }
  /// Of the tests of flips, what leads by itself: the tests are cosines of an angle, which changes within a hair's
  /// breadth where what leads dies away ever so much slower than the rest.
  std::array<double, 4> flips{};
  /// Eigenvectors of leading eigenvalues, each turned as at the place before: by a test of flips.
  std::array<Eigen::VectorXd, 4> leading{};
  // Of a central orbit.
  double curvature = 0;  // along the centre y' = curvature y^2 + ..., in sizes
  /// By how much the constants are off, in ranges, where `leaves_centre` and `comes_by_centre` are zero.
  std::array<double, 2> truncation_of_ends{};
  std::vector<std::vector<double>> carried{};  // directions in the unknowns that a renewed place is to have as well
};

/// A place at which a test is zero, and how far each component goes on along the orbit.
struct HomoclinicMark {
  HomoclinicPlace place;
  HomoclinicTest test;
  std::vector<double> advance{};
};

class HomoclinicSteps {
  using Vector = std::vector<double>;

 public:
  HomoclinicSteps(const ParametricSystem& system, const OrbitCurveOptions& options);

  /// From a closed orbit of long period that passes next to a saddle, or to where a saddle-node is about to be.
  [[nodiscard]] Result<HomoclinicPlace> first(const OrbitMark& mark);
  /// At an orbit of a saddle-node that is not central: as an orbit of the other kind, a saddle's or a central one, with
  /// a tangent of any direction.
  [[nodiscard]] std::optional<HomoclinicPlace> switched(const HomoclinicPlace& from, HomoclinicRest kind);
  /// From a place that is known, on intervals of this length at most.
  void take_up(const HomoclinicPlace& place, double longest);
  /// The one nearest to `guess` in the direction upright to `last` (in sizes), both on the mesh of `from`.
  [[nodiscard]] std::optional<HomoclinicPlace> near(const HomoclinicPlace& from, const Vector& guess,
                                                    const Vector& last);
  /// A difference of unknowns, as long as it counts at a place.
  [[nodiscard]] Vector in_sizes(const HomoclinicPlace& at, Vector difference);
  /// Nothing where none is found, or only one that is farther off than the step is long. The step may be negative.
  [[nodiscard]] std::optional<HomoclinicPlace> stepped(const HomoclinicPlace& from, double step);
  /// Between two neighbours on the same mesh, with one constant (0 or 1) at this value.
  [[nodiscard]] std::optional<HomoclinicPlace> at_bound(const HomoclinicPlace& a, const HomoclinicPlace& b,
                                                        std::size_t constant, double value);
  /// Takes a length and a mesh that serve the place, and solves for it there, where that has become worth it.
  [[nodiscard]] bool renew(HomoclinicPlace& place);
  /// What is followed at present.
  [[nodiscard]] HomoclinicRest kind() const { return kind_; }

 private:
  void use(const std::shared_ptr<const OrbitMesh>& mesh, double length);
  /// A first place of the present kind, near z.
  [[nodiscard]] std::optional<HomoclinicPlace> settled(const std::shared_ptr<const OrbitMesh>& mesh, double length,
                                                       const Vector& z);
  /// From a closed orbit that begins next to a saddle-node: `nodes` are its states on the mesh.
  [[nodiscard]] std::optional<HomoclinicPlace> first_central(const OrbitMesh& mesh, double period, const Vector& nodes,
                                                             const SaddleNode& rest);
  /// Renewed until it is as good as is wanted, or can be.
  void improve(HomoclinicPlace& place);
  /// The time that is missing at an end, in lengths of the interval.
  [[nodiscard]] double missing(const HomoclinicPlace& place, bool at_end) const;
  void measure(const Vector& z);
  [[nodiscard]] std::optional<HomoclinicPlace> corrected(const Vector& guess, const Vector& reference,
                                                         const Vector& last, const HomoclinicPlace* before);
  [[nodiscard]] std::optional<HomoclinicPlace> described(Vector z, const Vector& along, const HomoclinicPlace* before);
  [[nodiscard]] Vector adjoint_of(const HomoclinicPlace& place) const;
  void set_eigenvalue_tests(HomoclinicPlace& place) const;
  void set_flip_tests(HomoclinicPlace& place, const Vector& adjoint, const HomoclinicPlace* before) const;
  /// Of a central orbit, at the last factorization.
  void set_centre_tests(HomoclinicPlace& place) const;
  /// How the first or the last state's part along the centre changes with the unknowns, in scale.
  [[nodiscard]] Vector centre_part(bool at_end) const;
  [[nodiscard]] Vector shift_at(const Vector& z) const;
  [[nodiscard]] double weight(std::size_t node) const;
  [[nodiscard]] std::optional<Vector> tangent_of(const Vector& along);
  [[nodiscard]] bool refined(HomoclinicPlace& place);
  [[nodiscard]] bool lengthened(HomoclinicPlace& place);
  /// z and the tangent, read off where the interval goes from `begin` to `end`, 0 to 1 being the present one.
  [[nodiscard]] bool move_to(HomoclinicPlace& place, const std::shared_ptr<const OrbitMesh>& mesh, double begin,
                             double end);

  const ParametricSystem& system_;
  const OrbitCurveOptions& options_;
  std::size_t n_;
  HomoclinicRest kind_{};
  double error_wanted_, longest_ = 0, longer_along_centre_ = 0;
  std::shared_ptr<const OrbitMesh> mesh_;
  double length_ = 0;
  std::optional<HomoclinicOrbit> equations_;
  Vector sizes_, scale_;
};

}  // namespace continuo::studies::detail
