// Solves the rows of an island together, where its graph of bodies is thin enough to be factorized: stacks, arches,
// chains, mechanisms. Sweeps over the rows of a stack of n bodies need n^2 passes and more at unequal masses; the
// factorization needs one.
//
// The velocities v after a substep minimize a convex function (A. M. Castro, F. N. Permenter, X. Han, "An unconstrained
// convex formulation of compliant contact", IEEE Trans. Robotics 39, 2023):
//
//   1/2 (v - v*)^T M (v - v*) + sum of the penalties of the rows,
//   gradient M (v - v*) - J^T impulse(v),   impulse(v) = limited(impulse_0 - stiffness (J v + bias)),
//
// where v* are the velocities without constraints. Newton's method with a line search finds the minimum. A soft row has
// stiffness 1 / softness and impulse_0 = 0; of a rigid row, impulse_0 is that of the last substep and the stiffness is
// a large multiple of the mass, so that what the penalty leaves of J v + bias vanishes from substep to substep (the
// method of multipliers: M. R. Hestenes, J. Optim. Theory Appl. 4, 1969; M. J. D. Powell, 1969). The limit of friction
// follows the impulse along the normal from one iteration to the next.
//
// Rows that push bodies out of each other may contradict each other, as where boxes overlap between two walls. Then no
// impulses satisfy them, and multipliers would grow without end. So only the relaxing pass, which asks for no more than
// that overlaps do not grow, hands impulses on: the pushing pass begins with those of the last relaxing pass, and the
// next relaxing pass begins with the same ones.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/rigid_stepping/block_factorization.hpp>
#include <continuo/bodies/rigid_stepping/constraint_rows.hpp>

namespace continuo {

template <int Dim>
class DirectSolver {
 public:
  static constexpr int size_of_spin = Dim == 2 ? 1 : 3, size = Dim + size_of_spin;
  using Velocity = std::array<double, static_cast<std::size_t>(size)>;
  /// The two bodies of a block of rows, numbered within the island.
  struct Pair {
    std::uint32_t a = fixed, b = fixed;
    friend bool operator==(const Pair&, const Pair&) = default;
  };
  static constexpr std::uint32_t fixed = 0xffffffff;

  /// Whether an island with these pairs of bodies can be solved at the cost of `most_updates` products of blocks.
  [[nodiscard]] bool analyse(std::size_t bodies, std::span<const Pair> pairs, std::size_t most_updates) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Pair& pair : pairs)
      if (pair.a != fixed && pair.b != fixed && pair.a != pair.b) edges.emplace_back(pair.a, pair.b);
    pairs_.assign(pairs.begin(), pairs.end());
    return pattern_.analyse(bodies, edges, most_updates);
  }

  /// Takes the masses and the velocities of the bodies of the island: without constraints, or, for the second pass,
  /// those after the first. Moments of inertia are those of now, or of the beginning of the step: then rows stay valid.
  template <class Real>
  void load_bodies(std::span<const std::uint32_t> bodies, std::span<const RigidBody<Real, Dim>> all, RowPass pass,
                   bool is_inertia_of_now) {
    free_.resize(bodies.size()), mass_.resize(bodies.size()), inverse_mass_.resize(bodies.size());
    inverse_inertia_.resize(bodies.size());
    greatest_mass_ = greatest_inertia_ = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const RigidBody<Real, Dim>& body = all[bodies[i]];
      free_[i] = velocity_of(body);
      const Matrix<double, size_of_spin> inertia =
          inertia_of(body, is_inertia_of_now ? body.orientation : body.orientation_before);
      mass_[i] = mass_matrix(body, inertia);
      inverse_mass_[i] = static_cast<double>(body.inverse_mass);
      inverse_inertia_[i] = inverse(inertia);
      greatest_mass_ = std::max(greatest_mass_, mass_[i][0]);
      greatest_inertia_ = std::max(greatest_inertia_, mass_[i].back());
      stiffen(body, i, pass);
    }
  }
  /// Takes the rows of the blocks of the island, in the order of their pairs.
  template <class Real>
  void load_rows(std::span<const std::uint32_t> blocks, const Constraints<Real, Dim>& all,
                 std::span<const RigidBody<Real, Dim>> bodies) {
    rows_.clear(), blocks_.clear();
    is_factorized_ = false;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      RowBlock block = all.blocks[blocks[k]];
      const Pair& pair = pairs_[k];
      const auto rows = std::span(all.rows).subspan(block.first, block.rows);
      for (const ConstraintRow<Real, Dim>& row : rows) {
        Row& to = rows_.emplace_back();
        for (std::size_t i = 0; i < Dim; ++i) {
          const double along = static_cast<double>(row.direction[i]);
          to.on_a[i] = pair.a == fixed ? 0 : -along, to.on_b[i] = pair.b == fixed ? 0 : along;
        }
        for (std::size_t i = 0; i < std::size_t(size_of_spin); ++i) {
          to.on_a[Dim + i] = pair.a == fixed ? 0 : -static_cast<double>(row.lever_a[i]);
          to.on_b[Dim + i] = pair.b == fixed ? 0 : static_cast<double>(row.lever_b[i]);
        }
        // What a fixed or driven body gives does not change.
        RigidBody<Real, Dim> rest_a = bodies[block.a], rest_b = bodies[block.b];
        if (pair.a != fixed) rest_a.v = {}, rest_a.spin = {};
        if (pair.b != fixed) rest_b.v = {}, rest_b.spin = {};
        to.given = static_cast<double>(row.velocity(rest_a, rest_b));
        to.mass = static_cast<double>(row.mass);
        to.least = static_cast<double>(row.least), to.most = static_cast<double>(row.most);
        to.impulse = static_cast<double>(row.impulse);
        to.is_turn = row.direction == Vector<Real, Dim>{};
        to.is_limited = block.points > 0 || row.least > -std::numeric_limits<Real>::infinity() ||
                        row.most < std::numeric_limits<Real>::infinity();
      }
      block.first = static_cast<std::uint32_t>(rows_.size() - block.rows);
      blocks_.push_back(block);
    }
    load_biases(blocks, all);
  }
  /// Takes what the rows ask for, where nothing else has changed since `load_rows`.
  template <class Real>
  void load_biases(std::span<const std::uint32_t> blocks, const Constraints<Real, Dim>& all) {
    for (std::size_t k = 0, r = 0; k < blocks.size(); ++k)
      for (const auto& row : std::span(all.rows).subspan(all.blocks[blocks[k]].first, all.blocks[blocks[k]].rows)) {
        rows_[r].bias = static_cast<double>(row.bias), rows_[r].bias_at_end = static_cast<double>(row.bias_at_end);
        rows_[r].softness = blocks_[k].points > 0 ? 0 : static_cast<double>(row.softness);
        ++r;
      }
  }

  /// Takes the velocities as those after the impulses of the rows.
  void remove_impulses() {
    const std::vector<Velocity> after = velocities_of_impulses();
    for (std::size_t i = 0; i < free_.size(); ++i)
      for (std::size_t k = 0; k < after[i].size(); ++k) free_[i][k] = 2 * free_[i][k] - after[i][k];
  }
  /// Lets the next pass begin with the impulses from before the pushing pass.
  void begin_as_before_push() { starts_ = before_push_; }
  /// Finds the impulses, and the velocities that they give. False where it does not: then there is nothing to store.
  [[nodiscard]] bool solve(RowPass pass) {
    pass_ = pass;
    const std::vector<double> before = impulses();
    if (pass == RowPass::push && starts_.empty()) before_push_ = before;
    if (starts_.size() != before.size()) starts_ = before;
    const bool is_found = newton();
    starts_.clear();
    if (is_found) v_ = velocities_of_impulses();
    return is_found;
  }

  template <class Real>
  void store_bodies(std::span<const std::uint32_t> bodies, std::span<RigidBody<Real, Dim>> all) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      RigidBody<Real, Dim>& body = all[bodies[i]];
      for (std::size_t k = 0; k < Dim; ++k) body.v[k] = static_cast<Real>(v_[i][k]);
      for (std::size_t k = 0; k < std::size_t(size_of_spin); ++k) body.spin[k] = static_cast<Real>(v_[i][Dim + k]);
    }
  }
  template <class Real>
  void store_impulses(std::span<const std::uint32_t> blocks, Constraints<Real, Dim>& all) const {
    for (std::size_t k = 0, r = 0; k < blocks.size(); ++k)
      for (auto& row : all.of(all.blocks[blocks[k]])) row.impulse = static_cast<Real>(rows_[r++].impulse);
  }

 private:
  static constexpr double stiffness = 1e6;  // of rigid rows, per mass; rounding errors take 1e-16 times that
  static constexpr int most_updates_of_limits = 5, most_iterations = 60;
  enum class RowState : std::uint8_t { open, acts, slides };
  struct Row {
    Velocity on_a{}, on_b{};  // the row of J
    double given = 0, mass = 0, bias = 0, bias_at_end = 0, softness = 0, least = 0, most = 0, impulse = 0;
    double part = 1;              // of what friction would need that its limit allows
    double start = 0, slope = 0;  // impulse = limited(start - slope (J v + bias))
    double wanted = 0;            // impulse, without limits
    bool is_limited = false, is_turn = false;
    RowState state = RowState::open;
  };

  /// Adds what joints stiffen (add_stiffening) beyond the inertia itself. Below that the substep resolves the swing.
  template <class Real>
  void stiffen(const RigidBody<Real, Dim>& body, std::size_t i, RowPass pass) {
    double most = 0, least = 0;
    for (std::size_t k = 0; k < std::size_t(size_of_spin); ++k) {
      const double stiff = static_cast<double>(body.stiffening[k][k]), own = mass_[i][(Dim + k) * (size + 1)];
      most = std::max(most, stiff), least = k == 0 ? own : std::min(least, own);
    }
    if (most <= least) return;
    Matrix<double, size_of_spin> whole;
    std::array<double, std::size_t(size_of_spin)> momentum{};
    for (std::size_t c = 0; c < std::size_t(size_of_spin); ++c)
      for (std::size_t r = 0; r < std::size_t(size_of_spin); ++r) {
        double& inertia = mass_[i][(Dim + c) * size + Dim + r];
        momentum[r] += inertia * free_[i][Dim + c];
        inertia += (1 - least / most) * static_cast<double>(body.stiffening[c][r]);
        whole[c][r] = inertia;
      }
    inverse_inertia_[i] = inverse(whole);
    if (pass == RowPass::relax) return;
    for (std::size_t r = 0; r < std::size_t(size_of_spin); ++r) {
      free_[i][Dim + r] = 0;
      for (std::size_t c = 0; c < std::size_t(size_of_spin); ++c)
        free_[i][Dim + r] += inverse_inertia_[i][c][r] * momentum[c];
    }
  }
  template <class Real>
  [[nodiscard]] static Velocity velocity_of(const RigidBody<Real, Dim>& body) {
    Velocity v;
    for (std::size_t k = 0; k < Dim; ++k) v[k] = static_cast<double>(body.v[k]);
    for (std::size_t k = 0; k < std::size_t(size_of_spin); ++k) v[Dim + k] = static_cast<double>(body.spin[k]);
    return v;
  }
  /// Not the inverse of its inverse in the precision of the body: of the least
  /// moment of a needle that would have no digit in single precision.
  template <class Real>
  [[nodiscard]] static Matrix<double, size_of_spin> inertia_of(const RigidBody<Real, Dim>& body,
                                                               const Orientation<Real, Dim>& now) {
    Orientation<double, Dim> orientation;
    for (std::size_t k = 0; k < orientation.components.size(); ++k) orientation[k] = static_cast<double>(now[k]);
    Matrix<double, size_of_spin> own;
    for (std::size_t j = 0; j < std::size_t(size_of_spin); ++j)
      for (std::size_t i = 0; i < std::size_t(size_of_spin); ++i) own[j][i] = static_cast<double>(body.inertia[j][i]);
    return turned_inertia(rotation(orientation), own);
  }
  template <class Real>
  [[nodiscard]] static Block<size> mass_matrix(const RigidBody<Real, Dim>& body,
                                               const Matrix<double, size_of_spin>& inertia) {
    Block<size> m{};
    for (std::size_t k = 0; k < Dim; ++k) m[k * size + k] = 1 / static_cast<double>(body.inverse_mass);
    for (std::size_t j = 0; j < std::size_t(size_of_spin); ++j)
      for (std::size_t i = 0; i < std::size_t(size_of_spin); ++i)
        m[(Dim + j) * size + Dim + i] = (inertia[j][i] + inertia[i][j]) / 2;
    return m;
  }
  [[nodiscard]] static double product(const Velocity& a, const Velocity& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
  }
  static void add_multiple(Velocity& to, double factor, const Velocity& v) {
    for (std::size_t k = 0; k < v.size(); ++k) to[k] += factor * v[k];
  }
  [[nodiscard]] double residual(const Row& row, const Pair& pair, const std::vector<Velocity>& v) const {
    double sum = row.given + (pass_ == RowPass::push ? row.bias : row.bias_at_end);
    if (pair.a != fixed) sum += product(row.on_a, v[pair.a]);
    if (pair.b != fixed) sum += product(row.on_b, v[pair.b]);
    return sum;
  }

  /// When the gradient is small enough, as a change of velocity.
  [[nodiscard]] double accuracy() const {
    double greatest = 0, steepest = 0;
    for (const Velocity& v : free_) greatest = std::max(greatest, product(v, v));
    for (const Row& row : rows_) {
      const double asked = row.given + bias(row);
      // A contact that may still close asks for nothing.
      if (row.softness == 0 && (asked < 0 || row.least < 0)) greatest = std::max(greatest, asked * asked);
      if (row.mass > 0) steepest = std::max(steepest, row.slope / row.mass);
    }
    // Rounding errors of J v, times the stiffness, are in the gradient.
    return std::max(1e-8, 4e-15 * steepest) * std::sqrt(greatest) + 1e-14;
  }
  /// Joints that hold a large mass by small ones have to be as stiff as that needs.
  void set_stiffness() {
    for (Row& row : rows_) {
      row.slope = row.softness > 0 ? 1 / row.softness : stiffness * row.mass;
      if (row.softness > 0 || row.is_limited) continue;
      row.slope = std::max(row.slope, 1e4 * (row.is_turn ? greatest_inertia_ : greatest_mass_));
    }
  }
  [[nodiscard]] std::vector<double> impulses() const {
    std::vector<double> all;
    for (const Row& row : rows_) all.push_back(row.impulse);
    return all;
  }
  void restore(const std::vector<double>& impulses) {
    for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r].impulse = impulses[r];
  }
  [[nodiscard]] double bias(const Row& row) const { return pass_ == RowPass::push ? row.bias : row.bias_at_end; }
  /// Semismooth Newton: each iteration solves for the velocities as if all rows stayed in their states, and then looks
  /// which do, until the limits of friction are those that the impulses mean.
  [[nodiscard]] bool newton() {
    set_stiffness();
    for (const RowBlock& block : blocks_)
      for (std::size_t r = block.first; r < std::size_t(block.first + block.rows); ++r) {
        Row& row = rows_[r];
        // The impulses across the normals begin at 0, so that those of the points of a contact do not work against each
        // other for ever.
        const bool is_across = block.points > 0 && r >= std::size_t(block.first + block.points);
        // Those along them fade, so that a body that is squeezed does not store up more and more.
        const double kept = block.points > 0 ? 0.99 : 1;
        row.start = row.softness > 0 || is_across ? 0 : kept * starts_[r];
        row.wanted = row.impulse;
      }
    update_limits();
    v_ = velocities_of_impulses();
    bool have_states_changed = choose_states();
    bool is_found = false;
    const double small = accuracy();
    for (int k = 0, updates = 0;; ++k) {
      gradient(step_);
      if (size_of(step_) <= small) {
        is_found = true;
        found_ = impulses();
        if (updates == most_updates_of_limits || !update_limits()) return true;
        ++updates;
        have_states_changed |= choose_states();
        gradient(step_);
        if (size_of(step_) <= small) return true;
      }
      if (k == most_iterations) break;
      if (k == 0) have_states_changed = guess_states();
      set_impulses();
      gradient(step_);
      if (have_states_changed || !is_factorized_) {
        assemble();
        if (!factors_.factorize()) break;
        is_factorized_ = true;
      }
      factors_.solve(step_);
      for (std::size_t i = 0; i < v_.size(); ++i) add_multiple(v_[i], -1, step_[i]);
      have_states_changed = choose_states();
    }
    if (is_found) restore(found_);
    return is_found;
  }
  /// Sets the limits of friction. Returns whether one has changed by more than a thousandth of the greatest.
  bool update_limits() {
    double greatest = 0, change = 0;
    for (const RowBlock& block : blocks_)
      for (std::size_t point = 0; point < block.points; ++point) {
        const double limit = double(block.friction) * rows_[block.first + point].impulse;
        double& kept = rows_[block.first + block.points + point * (Dim - 1)].most;
        greatest = std::max(greatest, limit), change = std::max(change, std::abs(limit - kept));
        kept = limit;
      }
    return change > 1e-3 * greatest;
  }

  /// Chooses the states of the rows at v, and the impulses that those that slide have. Returns whether a state has
  /// changed.
  bool choose_states() {
    bool has_changed = false;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const RowBlock& block = blocks_[k];
      Row* const rows = &rows_[block.first];
      if (block.is_bounded) {
        has_changed |= choose_bounded<Dim>(rows, pairs_[k]);
        continue;
      }
      const std::size_t count = block.points > 0 ? block.points : block.rows;
      for (std::size_t r = 0; r < count; ++r) {
        Row& row = rows[r];
        const double wanted = row.start - row.slope * residual(row, pairs_[k], v_);
        // What was at one limit and would now be beyond the other one is between them.
        const bool has_turned = row.state == RowState::open && ((row.impulse == row.most && wanted < row.least) ||
                                                                (row.impulse == row.least && wanted > row.most));
        row.impulse = std::clamp(wanted, row.least, row.most);
        const bool acts = (wanted == row.impulse || has_turned) && row.mass > 0;
        has_changed |= set(row, acts ? RowState::acts : RowState::open);
      }
      for (std::size_t point = 0; point < block.points; ++point)
        has_changed |= choose_bounded<Dim - 1>(&rows[block.points + point * (Dim - 1)], pairs_[k]);
    }
    return has_changed;
  }
  /// Of rows whose impulses have a bounded length, as those of friction and of a pull. The first one has the limit.
  template <std::size_t Count>
  bool choose_bounded(Row* rows, const Pair& pair) {
    const double most = rows->most;
    std::array<double, Count> wanted;
    double square = 0, along = 0;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      wanted[k] = rows[k].start - rows[k].slope * residual(rows[k], pair, v_);
      square += wanted[k] * wanted[k], along += wanted[k] * rows[k].impulse;
    }
    // What slid and would now slide back has come to rest in between.
    const bool has_turned = rows[0].state == RowState::slides && along < 0;
    const bool slides = square > most * most && !has_turned;
    limit_length(wanted, most);
    const double part = slides ? most / std::sqrt(square) : 1;
    bool has_changed = Count > 1 && slides && most > 0 && has_another_slope<Count>(rows, wanted, part);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      rows[k].impulse = wanted[k];
      rows[k].part = part;
      has_changed |= set(rows[k], most == 0 ? RowState::open : slides ? RowState::slides : RowState::acts);
    }
    return has_changed;
  }
  /// Whether the stiffness across rows that slide differs from that of the last state by more than a hundredth: with an
  /// old one the direction of sliding would creep to where it belongs.
  template <std::size_t Count>
  [[nodiscard]] static bool has_another_slope(const Row* rows, const std::array<double, Count>& impulses, double part) {
    double square = 0, change = 0;
    for (std::size_t k = 0; k < Count; ++k) {
      const double difference = impulses[k] - rows[k].impulse;
      square += impulses[k] * impulses[k], change += difference * difference;
    }
    return std::abs(part - rows->part) > 0.01 * part || change > 1e-4 * square;
  }
  /// The states that the impulses mean with which the iterations begin.
  bool guess_states() {
    bool has_changed = false;
    for (const RowBlock& block : blocks_) {
      Row* const rows = &rows_[block.first];
      if (block.is_bounded) {
        has_changed |= guess_bounded<Dim>(rows);
        continue;
      }
      const std::size_t count = block.points > 0 ? block.points : block.rows;
      for (std::size_t r = 0; r < count; ++r)
        has_changed |= set(
            rows[r], rows[r].wanted > rows[r].least && rows[r].wanted < rows[r].most ? RowState::acts : RowState::open);
      for (std::size_t r = 0; r < count; ++r)
        if (rows[r].state == RowState::open) rows[r].impulse = rows[r].wanted;
      for (std::size_t point = 0; point < block.points; ++point)
        has_changed |= guess_bounded<Dim - 1>(rows + block.points + point * (Dim - 1));
    }
    return has_changed;
  }
  template <std::size_t Count>
  static bool guess_bounded(Row* rows) {
    double square = 0;
    for (std::size_t k = 0; k < Count; ++k) square += rows[k].wanted * rows[k].wanted;
    const double most = rows->most;
    const bool slides = square >= most * most * (1 - 1e-6);
    bool has_changed = false;
    for (std::size_t k = 0; k < Count; ++k) {
      has_changed |= set(rows[k], most == 0 ? RowState::open : slides ? RowState::slides : RowState::acts);
      if (rows[k].state != RowState::acts) rows[k].impulse = rows[k].wanted;
      rows[k].part = 1e-3;
    }
    return has_changed;
  }
  static bool set(Row& row, RowState state) { return std::exchange(row.state, state) != state; }
  /// The impulses that acting rows have at v.
  void set_impulses() {
    for (std::size_t k = 0; k < blocks_.size(); ++k)
      for (Row& row : std::span(rows_).subspan(blocks_[k].first, blocks_[k].rows))
        if (row.state == RowState::acts) row.impulse = row.start - row.slope * residual(row, pairs_[k], v_);
  }

  /// M (v - v*) - J^T impulse.
  void gradient(std::vector<Velocity>& g) const {
    g.assign(v_.size(), {});
    for (std::size_t i = 0; i < v_.size(); ++i)
      for (std::size_t c = 0; c < std::size_t(size); ++c)
        for (std::size_t r = 0; r < std::size_t(size); ++r)
          g[i][r] += mass_[i][c * size + r] * (v_[i][c] - free_[i][c]);
    for_each_impulse(
        [&](std::size_t body, double impulse, const Velocity& row) { add_multiple(g[body], -impulse, row); });
  }
  /// v* + M^-1 J^T impulse.
  [[nodiscard]] std::vector<Velocity> velocities_of_impulses() const {
    std::vector<Velocity> sum(free_.size());
    for_each_impulse(
        [&](std::size_t body, double impulse, const Velocity& row) { add_multiple(sum[body], impulse, row); });
    for (std::size_t i = 0; i < sum.size(); ++i) {
      Velocity v = free_[i];
      for (std::size_t k = 0; k < Dim; ++k) v[k] += inverse_mass_[i] * sum[i][k];
      for (std::size_t c = 0; c < std::size_t(size_of_spin); ++c)
        for (std::size_t r = 0; r < std::size_t(size_of_spin); ++r)
          v[Dim + r] += inverse_inertia_[i][c][r] * sum[i][Dim + c];
      sum[i] = v;
    }
    return sum;
  }
  template <class Act>
  void for_each_impulse(Act&& act) const {
    for (std::size_t k = 0; k < blocks_.size(); ++k)
      for (const Row& row : std::span(rows_).subspan(blocks_[k].first, blocks_[k].rows)) {
        if (row.impulse == 0) continue;
        if (pairs_[k].a != fixed) act(pairs_[k].a, row.impulse, row.on_a);
        if (pairs_[k].b != fixed) act(pairs_[k].b, row.impulse, row.on_b);
      }
  }
  /// The greatest change of velocity that a gradient means.
  [[nodiscard]] double size_of(const std::vector<Velocity>& g) const {
    double most = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      double square = 0;
      for (std::size_t k = 0; k < Dim; ++k) square += g[i][k] * g[i][k];
      most = std::max(most, inverse_mass_[i] * std::sqrt(square));
      for (std::size_t c = 0; c < std::size_t(size_of_spin); ++c)
        most = std::max(most, std::abs(inverse_inertia_[i][c][c] * g[i][Dim + c]));
    }
    return most;
  }

  /// M + J^T slope J.
  void assemble() {
    factors_.clear(pattern_);
    for (std::size_t i = 0; i < mass_.size(); ++i) factors_.diagonal(i) = mass_[i];
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const RowBlock& block = blocks_[k];
      const Pair& pair = pairs_[k];
      Block<size> aa{}, bb{}, ba{};
      const auto add = [&](const Velocity& a, const Velocity& b, double slope) {
        for (std::size_t c = 0; c < std::size_t(size); ++c)
          for (std::size_t r = 0; r < std::size_t(size); ++r) {
            aa[c * size + r] += slope * a[r] * a[c];
            bb[c * size + r] += slope * b[r] * b[c];
            ba[c * size + r] += slope * b[r] * a[c];
          }
      };
      const Row* const rows = &rows_[block.first];
      for (std::size_t r = 0; r < block.rows; ++r) {
        const Row& row = rows[r];
        if (row.state == RowState::acts) add(row.on_a, row.on_b, row.slope);
        if (row.state != RowState::slides) continue;
        if (block.is_bounded) {
          assemble_bounded(std::span<const Row>(rows, Dim), add);
          break;
        }
        if (Dim == 2) continue;
        // Two rows: what is across the direction of sliding acts, weaker the faster it slides.
        const Row& next = rows[++r];
        const double square = row.impulse * row.impulse + next.impulse * next.impulse;
        if (square == 0) continue;
        const double along = row.impulse / std::sqrt(square), across = next.impulse / std::sqrt(square);
        Velocity a{}, b{};
        add_multiple(a, across, row.on_a), add_multiple(a, -along, next.on_a);
        add_multiple(b, across, row.on_b), add_multiple(b, -along, next.on_b);
        add(a, b, row.slope * row.part);
      }
      const auto add_to = [](Block<size>& to, const Block<size>& block_of_rows) {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += block_of_rows[i];
      };
      if (pair.a != fixed) add_to(factors_.diagonal(pair.a), aa);
      if (pair.b != fixed) add_to(factors_.diagonal(pair.b), bb);
      if (pair.a != fixed && pair.b != fixed) factors_.add(pair.b, pair.a, ba);
    }
  }

  /// The stiffness of a pull at its greatest force, which only turns: that of its spring, across the force, as much
  /// smaller as the force is smaller than what the spring wants.
  template <class Add>
  static void assemble_bounded(std::span<const Row> rows, Add&& add) {
    double square = 0;
    for (const Row& row : rows) square += row.impulse * row.impulse;
    if (square == 0) return;
    Velocity a{}, b{};
    double slope = 0;
    for (const Row& row : rows) {
      const double along = row.impulse / std::sqrt(square);
      add_multiple(a, along, row.on_a), add_multiple(b, along, row.on_b);
      slope += row.slope * row.part * (1 - along * along) / (Dim - 1);
    }
    for (const Row& row : rows) add(row.on_a, row.on_b, slope);
    add(a, b, -slope);
  }

  BlockPattern pattern_;
  BlockFactorization<size> factors_;
  std::vector<Pair> pairs_;
  std::vector<RowBlock> blocks_;
  std::vector<Row> rows_;
  std::vector<Velocity> free_, v_, step_;
  std::vector<Block<size>> mass_;
  std::vector<double> inverse_mass_, found_;
  std::vector<double> starts_, before_push_;  // impulses of the rows
  std::vector<Matrix<double, size_of_spin>> inverse_inertia_;
  double greatest_mass_ = 0, greatest_inertia_ = 0;
  RowPass pass_ = RowPass::push;
  bool is_factorized_ = false;
};

}  // namespace continuo
