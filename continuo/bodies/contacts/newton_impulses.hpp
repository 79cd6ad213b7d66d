// The impulses of contacts with friction that act together, by Newton's method. The sweeps of
// projected_gauss_seidel.hpp need more of them the more the masses differ; this needs a few solutions of a linear
// system whatever the masses are, but grows with the third power of the number of contacts.
//
// The laws of contact are the zeros of the natural map (P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92
// (1991) 353-375): an impulse is what is left of it, less the speed that it answers over the compliance of its contact,
// after a projection onto what it may be: at least 0 along the normal, in the disc of friction across it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/minimum_norm.hpp>
#include <continuo/bodies/contacts/persistent_contact.hpp>
#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>

namespace continuo {

template <class Real, int Dim>
class NewtonImpulses {
 public:
  using Sweeps = ProjectedGaussSeidel<Real, Dim>;
  using Moving = typename Sweeps::Moving;
  /// For so many rows it costs no more than sweeps that do not find the impulses.
  static constexpr std::size_t usual_rows = 64;

  /// The rows of `sweeps`, and the state before any impulse.
  NewtonImpulses(const Sweeps& sweeps, std::span<const Moving> free) : rows_(sweeps.rows()), free_(free) {
    list_unknowns();
    list_responses();
  }

  /// Searches from the impulses of the rows. Returns those that violate the laws of contact least, of all that were
  /// tried. A round costs 4/3 n^3 products for n unknowns, two to five for each contact that presses; five to ten
  /// rounds are usual, 30 the most.
  [[nodiscard]] std::vector<ContactImpulse<Real, Dim>> find() { return impulses(search(begin()).at); }
  /// The same, but first with a part of the friction, from 0 on, each time from the impulses before: where `find` goes
  /// in circles, this often does not.
  [[nodiscard]] std::vector<ContactImpulse<Real, Dim>> find_by_parts() {
    constexpr int parts = 8;
    std::vector<Wide> at = begin();
    for (int k = 0; k <= parts; ++k) {
      part_ = Wide(k) / parts;
      at = search(std::move(at)).at;
    }
    return impulses(at);
  }

 private:
  /// What a heavy body is pushed is so much more than what a light one between it and another may differ by.
  using Wide = std::conditional_t<std::is_same_v<Real, float>, double, long double>;
  using V = Vector<Wide, Dim>;
  using S = Spin<Wide, Dim>;
  using Row = typename Sweeps::Row;
  static constexpr Wide rounding = Wide(16) * std::numeric_limits<Wide>::epsilon();
  static constexpr std::size_t ways = Dim - 1;  // across a normal

  struct Found {
    std::vector<Wide> at;
    Wide violation;
  };

  /// Newton's method from these impulses, with a part of the friction.
  [[nodiscard]] Found search(std::vector<Wide> at) {
    constexpr int most_rounds = 30;
    Wide error = violation(at);
    Found best{at, error};
    for (int round = 0; round < most_rounds; ++round) {
      if (best.violation <= rounding * magnitude_ || !find_step(at)) break;
      error = go_on(at, error);
      if (error < best.violation) best.violation = error, best.at = at;
    }
    return best;
  }

  /// Each group begins with the unknown along the normal; then come those across it, and those of rolling.
  struct Group {
    std::size_t first = 0, slips = 0, rolls = 0;
    V normal{};
    std::array<V, ways> across{};
    Wide of_slip{}, of_roll{};
  };

  template <class To, class From>
  [[nodiscard]] static To widened(const From& from) {
    To to{};
    for (std::size_t k = 0; k < To::size(); ++k) to[k] = Wide(from[k]);
    return to;
  }
  void list_unknowns() {
    for (const Row& row : rows_) {
      Group group{.first = n_, .normal = widened<V>(row.normal)};
      const bool rubs = row.friction > Real(0);
      group.slips = rubs ? ways : 0;
      group.rolls = rubs && row.resistance > Real(0) ? ways : 0;
      std::ranges::copy(continuo::across(group.normal), group.across.begin());
      n_ += 1 + group.slips + group.rolls;
      groups_.push_back(group);
    }
  }
  /// The direction of a spin about which a contact rolls.
  [[nodiscard]] static S about(const Group& group, std::size_t way) {
    if constexpr (Dim == 2) {
      static_cast<void>(group), static_cast<void>(way);
      return S{{Wide(1)}};
    } else {
      return group.across[way];
    }
  }
  [[nodiscard]] static Wide over(const Moving& one) {
    return one.radius > Real(0) ? Wide(one.turn) / Wide(one.radius) : Wide(0);
  }
  /// The rates of the unknowns of a row where its bodies move so: of separation, of slip, of rolling.
  template <class To>
  void put_rates(std::size_t k, const V& v_a, const S& spin_a, const V& v_b, const S& spin_b, To&& to) const {
    const Row& row = rows_[k];
    const Group& group = groups_[k];
    const Moving &a = free_[row.a], &b = free_[row.b];
    const V rate = v_b - v_a;
    to(group.first, dot(rate, group.normal));
    const V turned = turning(S(spin_a * Wide(a.radius) + spin_b * Wide(b.radius)), group.normal);
    for (std::size_t way = 0; way < group.slips; ++way)
      to(group.first + 1 + way, dot(V(rate - turned), group.across[way]));
    for (std::size_t way = 0; way < group.rolls; ++way)
      to(group.first + 1 + group.slips + way, dot(S(spin_b - spin_a), about(group, way)) * Wide(row.arm));
  }
  /// The rates without impulses, and what impulses of 1 add to them.
  void list_responses() {
    rates_.resize(n_), response_.assign(n_ * n_, Wide(0));
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Moving &a = free_[rows_[k].a], &b = free_[rows_[k].b];
      put_rates(k, widened<V>(a.v), widened<S>(a.spin), widened<V>(b.v), widened<S>(b.spin),
                [&](std::size_t u, const Wide& rate) { rates_[u] = rate; });
      rates_[groups_[k].first] -= Wide(rows_[k].least);
      list_columns(k);
    }
    for (std::size_t k = 0; k < rows_.size(); ++k) response_[groups_[k].first * (n_ + 1)] += Wide(rows_[k].compliance);
    for (Group& group : groups_) {
      const auto greatest = [&](std::size_t first, std::size_t count) {
        Wide most(0);
        for (std::size_t u = first; u < first + count; ++u) most = std::max(most, response_[u * n_ + u]);
        return most;
      };
      group.of_slip = greatest(group.first + 1, group.slips);
      group.of_roll = greatest(group.first + 1 + group.slips, group.rolls);
    }
  }
  void list_columns(std::size_t k) {
    const Group& group = groups_[k];
    put_column(k, group.first, group.normal, S{}, S{});
    for (std::size_t way = 0; way < group.slips; ++way)
      put_column(k, group.first + 1 + way, group.across[way], moment(group.normal, group.across[way]), S{});
    for (std::size_t way = 0; way < group.rolls; ++way)
      put_column(k, group.first + 1 + group.slips + way, V{}, S{}, about(group, way));
  }
  /// The rates of all rows by an impulse of row k on its second body, the opposite on its first, a moment over the
  /// radius on both, and a couple.
  void put_column(std::size_t k, std::size_t column, const V& impulse, const S& twist, const S& couple) {
    const Row& from = rows_[k];
    const Moving &a = free_[from.a], &b = free_[from.b];
    const V v_a = impulse * -Wide(a.inverse_mass), v_b = impulse * Wide(b.inverse_mass);
    const S spin_a = twist * -Wide(a.turn) - couple * (Wide(from.arm) * over(a)),
            spin_b = twist * -Wide(b.turn) + couple * (Wide(from.arm) * over(b));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto part = [&](std::uint32_t place, V& v, S& spin) {
        if (place == 0) return false;
        if (place == from.a) v = v_a, spin = spin_a;
        if (place == from.b) v = v_b, spin = spin_b;
        return place == from.a || place == from.b;
      };
      V v_i{}, v_j{};
      S spin_i{}, spin_j{};
      const bool first = part(rows_[i].a, v_i, spin_i), second = part(rows_[i].b, v_j, spin_j);
      if (!first && !second) continue;
      put_rates(i, v_i, spin_i, v_j, spin_j,
                [&](std::size_t row, const Wide& rate) { response_[row * n_ + column] = rate; });
    }
  }
  [[nodiscard]] std::vector<Wide> begin() const {
    std::vector<Wide> at(n_);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Group& group = groups_[k];
      const auto& impulse = rows_[k].impulse;
      at[group.first] = Wide(impulse.press);
      for (std::size_t way = 0; way < group.slips; ++way)
        at[group.first + 1 + way] = dot(widened<V>(impulse.rub), group.across[way]);
      for (std::size_t way = 0; way < group.rolls; ++way)
        at[group.first + 1 + group.slips + way] = dot(widened<S>(impulse.roll), about(group, way));
    }
    return at;
  }
  [[nodiscard]] std::vector<ContactImpulse<Real, Dim>> impulses(const std::vector<Wide>& at) const {
    std::vector<ContactImpulse<Real, Dim>> found(rows_.size());
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Group& group = groups_[k];
      const Wide press = std::max(Wide(0), at[group.first]);
      V rub{};
      S roll{};
      for (std::size_t way = 0; way < group.slips; ++way) rub += group.across[way] * at[group.first + 1 + way];
      for (std::size_t way = 0; way < group.rolls; ++way)
        roll += about(group, way) * at[group.first + 1 + group.slips + way];
      rub = shortened(rub, Wide(rows_[k].friction) * press);
      roll = shortened(roll, Wide(rows_[k].resistance) * press);
      found[k].press = static_cast<Real>(press);
      for (std::size_t axis = 0; axis < Dim; ++axis) found[k].rub[axis] = static_cast<Real>(rub[axis]);
      for (std::size_t axis = 0; axis < S::size(); ++axis) found[k].roll[axis] = static_cast<Real>(roll[axis]);
    }
    return found;
  }

  template <class W>
  [[nodiscard]] static W shortened(const W& load, const Wide& most) {
    const Wide size = length(load);
    return size > most ? load * (most / size) : load;
  }
  void find_rates(const std::vector<Wide>& at) {
    now_ = rates_;
    magnitude_ = Wide(0);
    for (std::size_t u = 0; u < n_; ++u) {
      Wide size = std::abs(rates_[u]);
      for (std::size_t w = 0; w < n_; ++w)
        if (const Wide by = response_[u * n_ + w] * at[w]; by != Wide(0)) now_[u] += by, size += std::abs(by);
      magnitude_ = std::max(magnitude_, size);
    }
  }
  /// Where the projection of some unknowns onto a disc is: at its rim, and in which direction.
  struct Limited {
    bool at_rim = false;
    std::array<Wide, ways> way{};
    Wide size{}, limit{};
  };
  [[nodiscard]] Limited limited(const std::vector<Wide>& at, std::size_t first, const Wide& compliance,
                                const Wide& limit) const {
    Limited found{.limit = limit};
    Wide square(0);
    for (std::size_t way = 0; way < ways; ++way) {
      found.way[way] = at[first + way] - now_[first + way] / compliance;
      square += found.way[way] * found.way[way];
    }
    found.size = std::sqrt(square);
    found.at_rim = found.size > limit;
    if (found.at_rim)
      for (Wide& part : found.way) part /= found.size;
    return found;
  }
  /// The natural map, in units of speed, at the unknowns whose rates are known. Returns the sum of its squares.
  Wide map(const std::vector<Wide>& at) {
    value_.assign(n_, Wide(0));
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Group& group = groups_[k];
      const std::size_t u = group.first;
      const Wide compliance = response_[u * n_ + u];
      value_[u] = std::min(now_[u], Wide(at[u] * compliance));
      const Wide press = std::max(Wide(0), Wide(at[u] - now_[u] / compliance));
      if (group.slips > 0) map_disc(at, u + 1, group.of_slip, part_ * Wide(rows_[k].friction) * press);
      if (group.rolls > 0) map_disc(at, u + 1 + group.slips, group.of_roll, part_ * Wide(rows_[k].resistance) * press);
    }
    Wide sum(0);
    for (const Wide& one : value_) sum += one * one;
    return sum;
  }
  void map_disc(const std::vector<Wide>& at, std::size_t first, const Wide& compliance, const Wide& limit) {
    const Limited to = limited(at, first, compliance, limit);
    for (std::size_t way = 0; way < ways; ++way)
      value_[first + way] = to.at_rim ? (at[first + way] - limit * to.way[way]) * compliance : now_[first + way];
  }
  /// The length of the natural map.
  [[nodiscard]] Wide violation(const std::vector<Wide>& at) {
    find_rates(at);
    return std::sqrt(map(at));
  }

  /// Newton's step at the unknowns whose map is known, the shortest where contacts make others redundant. The impulses
  /// of contacts that open go to 0. False where there is none.
  [[nodiscard]] bool find_step(const std::vector<Wide>& at) {
    step_.assign(n_, Wide(0)), pressed_.clear();
    for (const Group& group : groups_) {
      const std::size_t u = group.first, end = u + 1 + group.slips + group.rolls;
      const bool presses = now_[u] < at[u] * response_[u * n_ + u];
      for (std::size_t w = u; w < end; ++w) presses ? pressed_.push_back(w) : static_cast<void>(step_[w] = at[w]);
    }
    const std::size_t n = pressed_.size();
    matrix_.resize(n * n), wanted_.resize(n);
    std::size_t i = 0;
    for (std::size_t k = 0; k < groups_.size() && i < n; ++k) {
      if (pressed_[i] != groups_[k].first) continue;
      const std::size_t end = groups_[k].first + 1 + groups_[k].slips + groups_[k].rolls;
      for (std::size_t u = groups_[k].first; u < end; ++u, ++i) {
        find_slope(at, k, u);
        wanted_[i] = value_[u];
        for (std::size_t w = 0; w < n_; ++w) wanted_[i] -= slope_[w] * step_[w];
        for (std::size_t j = 0; j < n; ++j) matrix_[j * n + i] = slope_[pressed_[j]];
      }
    }
    system_.factor(n, matrix_);
    system_.solve(wanted_);
    for (std::size_t k = 0; k < n; ++k) step_[pressed_[k]] = wanted_[k];
    return std::ranges::all_of(step_, [](const Wide& one) { return one - one == 0; });
  }
  /// The slope of the map of unknown u, of contact k, which presses.
  void find_slope(const std::vector<Wide>& at, std::size_t k, std::size_t u) {
    const Group& group = groups_[k];
    const std::size_t first_slip = group.first + 1, first_roll = first_slip + group.slips;
    const auto take_rate = [&] { std::copy_n(&response_[u * n_], n_, slope_.begin()); };
    slope_.assign(n_, Wide(0));
    if (u == group.first) return take_rate();
    const bool is_roll = u >= first_roll;
    const std::size_t first = is_roll ? first_roll : first_slip;
    const Wide compliance = is_roll ? group.of_roll : group.of_slip,
               factor = part_ * Wide(is_roll ? rows_[k].resistance : rows_[k].friction);
    const std::size_t n = group.first;
    const Wide of_normal = response_[n * n_ + n];
    const Limited to = limited(at, first, compliance, Wide(factor * (at[n] - now_[n] / of_normal)));
    if (!to.at_rim) return take_rate();
    const Wide part = factor * to.way[u - first] * compliance;
    for (std::size_t w = 0; w < n_; ++w) slope_[w] = part / of_normal * response_[n * n_ + w];
    slope_[u] += compliance, slope_[n] -= part;
    if constexpr (ways == 2) add_turn(to, first, u, compliance);
  }
  /// Of f - limit y / |y|, with y = f - rate / compliance: y / |y| turns by what of the change of y is across it.
  void add_turn(const Limited& to, std::size_t first, std::size_t u, const Wide& compliance) {
    const std::array<Wide, 2> beside{-to.way[1], to.way[0]};
    const Wide turn = to.limit / to.size * beside[u - first];
    for (std::size_t other = 0; other < 2; ++other) {
      slope_[first + other] -= turn * beside[other] * compliance;
      for (std::size_t w = 0; w < n_; ++w) slope_[w] += turn * beside[other] * response_[(first + other) * n_ + w];
    }
  }
  /// Goes along the step as far as the violation falls, at least a little. Returns what is left of it.
  Wide go_on(std::vector<Wide>& at, const Wide& error) {
    const std::vector<Wide> from = at;
    Wide now = error;
    for (Wide part(1); part > Wide(1) / 64; part /= 2) {
      for (std::size_t u = 0; u < n_; ++u) at[u] = from[u] - part * step_[u];
      now = violation(at);
      if (now < error) break;
    }
    return now;
  }

  const std::vector<Row>& rows_;
  std::span<const Moving> free_;
  std::size_t n_ = 0;  // unknowns
  std::vector<Group> groups_;
  std::vector<Wide> rates_, response_;  // response_: row by row
  std::vector<Wide> now_, value_, slope_, step_;
  Wide part_ = Wide(1);  // of the friction
  Wide magnitude_{};     // of the sums that rates are
  std::vector<std::size_t> pressed_;
  std::vector<Wide> matrix_, wanted_;  // of these unknowns; matrix_: column by column
  MinimumNorm<Wide> system_;
};

}  // namespace continuo
