// continuo/bodies/exact_motion.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <continuo/bodies/cell_grid.hpp>
#include <continuo/bodies/collision_time.hpp>
#include <continuo/bodies/event_queue.hpp>
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/impulse.hpp>

namespace continuo {

template <class Real, int Dim>
class ExactMotion<Real, Dim>::Flight {
 public:
  using V = Vector<Real, Dim>;
  using Grid = CellGrid<Real, Dim>;

  Flight(World<Real, Dim>& world, const ExactOptions<Real>& options) : world_(world), options_(options) { refresh(); }

  void refresh() {
    const std::size_t n = world_.size();
    now_ = world_.time;
    contact_time_ = options_.contact_time ? *options_.contact_time : usual_contact_time();
    choose_cells();
    queue_ = EventQueue<Real>(n);
    balls_.assign(n, {});
    for (std::uint32_t i = 0; i < n; ++i) {
      Ball& ball = balls_[i];
      ball.x = world_.position[i];
      ball.v = world_.velocity[i];
      ball.t = now_;
      ball.last_collision = -never;
      ball.radius = world_.radius[i];
      ball.is_fixed = world_.is_fixed(i);
      ball.a = ball.is_fixed ? V{} : world_.gravity;
      ball.is_large = 2 * ball.radius > grid_.edge();
      if (ball.is_large) {
        large_.push_back(i);
      } else {
        ball.cell = grid_.cell_of(ball.x);
        grid_.insert(i, ball.cell);
      }
    }
    for (std::uint32_t i = 0; i < n; ++i) predict(i);
  }

  std::string advance_to(const Real& t) {
    if (!only_gravity(world_)) return "exact collisions need gravity as the only force; other forces go by steps";
    if (!(t >= now_) || !(t - t == Real(0))) return "the time to advance to must be finite and not before the present";
    std::size_t events = 0;
    while (!queue_.empty() && queue_.time() <= t) {
      if (++events > options_.most_events) {
        synchronize(now_);
        return "more events than `most_events`: bodies may be caught between others";
      }
      now_ = std::max(now_, queue_.time());
      handle(queue_.first());
    }
    synchronize(t);
    return {};
  }

  ExactStatistics statistics{};

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  // Who the next collision is with: a body, a wall (from first_wall on), nobody known yet.
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max(), look_again = nobody - 1,
                                 first_wall = std::uint32_t{1} << 31;

  struct Ball {
    V x{}, v{}, a{};  // at the time t of its own
    Real t{}, radius{};
    Real collision_time = never, crossing_time = never;
    std::uint32_t partner = nobody, collisions_of_partner = 0;
    std::uint32_t collisions = 0;  // so many changes of its path; a prediction holds for one of them
    bool is_fixed = false, is_large = false, is_resting = false;
    std::int8_t direction = 0;
    std::uint8_t axis = 0;
    typename Grid::Cell cell{};
    Real last_collision{};
  };

  Real usual_contact_time() const {
    using std::sqrt;
    Real smallest = never, fastest(0);
    for (std::size_t i = 0; i < world_.size(); ++i) {
      smallest = std::min(smallest, world_.radius[i]);
      fastest = std::max(fastest, length(world_.velocity[i]));
    }
    const Real g = length(world_.gravity);
    if (g > Real(0)) return Real(1e-5) * sqrt(2 * smallest / g);
    return fastest > Real(0) ? Real(1e-5) * smallest / fastest : Real(0);
  }

  /// Cells that hold about one body and are wider than any but the few large ones.
  void choose_cells() {
    const std::size_t n = world_.size();
    large_.clear();
    std::vector<Real> sorted = world_.radius;
    if (n == 0) return void(grid_ = Grid(Real(1), 1));
    const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(n / 2);
    std::nth_element(sorted.begin(), median, sorted.end());
    const Real usual = 4 * *median;
    Real widest(0);
    for (const Real& radius : sorted)
      if (radius <= usual) widest = std::max(widest, radius);
    Real room(1);  // of nine tenths of the bodies, by axis
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      std::vector<Real> place(n);
      for (std::size_t i = 0; i < n; ++i) place[i] = world_.position[i][axis];
      const std::size_t tail = n / 20;
      std::nth_element(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(tail), place.end());
      const Real low = place[tail];
      std::nth_element(place.begin(), place.end() - 1 - static_cast<std::ptrdiff_t>(tail), place.end());
      room *= std::max(Real(place[n - 1 - tail] - low), 2 * widest);
    }
    using std::pow;
    const Real spacing = Real(pow(room / static_cast<Real>(n), Real(1) / Real(Dim)));
    grid_ = Grid(std::max(Real(2) * widest, std::min(spacing, 1000 * widest)) * Real(1.0001), n);
  }

  void move_to(Ball& ball, const Real& t) const {
    const Real dt = t - ball.t;
    ball.x += ball.v * dt + ball.a * (dt * dt / 2);
    ball.v += ball.a * dt;
    ball.t = t;
  }

  void synchronize(const Real& t) {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      Ball at = balls_[i];
      move_to(at, t);
      world_.position[i] = at.x;
      world_.velocity[i] = at.v;
      if (!at.is_fixed)
        world_.orientation[i] =
            turned(world_.orientation[i], world_.spin[i], t - (spun_to_.empty() ? world_.time : spun_to_[i]));
    }
    spun_to_.assign(balls_.size(), t);
    world_.time = now_ = t;
  }

  // Prediction

  void predict(std::uint32_t i) {
    Ball& ball = balls_[i];
    ball.collision_time = ball.crossing_time = never;
    ball.partner = nobody;
    if (!ball.is_fixed) {
      move_to(ball, now_);
      predict_crossing(ball);
      for (std::uint32_t w = 0; w < world_.walls().size(); ++w) predict_wall(ball, w);
    }
    if (ball.is_large) {
      if (!ball.is_fixed)
        for (std::uint32_t j = 0; j < balls_.size(); ++j) predict_pair(i, j);
    } else if (!ball.is_fixed) {
      auto lower = ball.cell, upper = ball.cell;
      for (std::size_t axis = 0; axis < lower.size(); ++axis) --lower[axis], ++upper[axis];
      grid_.for_each_in(lower, upper, [&](std::uint32_t j) { predict_pair(i, j); });
      for (const std::uint32_t j : large_) predict_pair(i, j);
    }
    schedule(i);
  }
  void schedule(std::uint32_t i) { queue_.set(i, std::min(balls_[i].collision_time, balls_[i].crossing_time)); }

  void predict_crossing(Ball& ball) {
    if (ball.is_large) return;
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real lower = grid_.edge() * static_cast<Real>(ball.cell[axis]), upper = lower + grid_.edge();
      take_crossing(ball, time_to_close(Real(ball.x[axis] - lower), ball.v[axis], ball.a[axis]), axis, -1);
      take_crossing(ball, time_to_close(Real(upper - ball.x[axis]), Real(-ball.v[axis]), Real(-ball.a[axis])), axis, 1);
    }
  }
  void take_crossing(Ball& ball, const Real& wait, std::size_t axis, int direction) {
    if (!(now_ + wait < ball.crossing_time)) return;
    ball.crossing_time = now_ + wait;
    ball.axis = static_cast<std::uint8_t>(axis);
    ball.direction = static_cast<std::int8_t>(direction);
  }

  void predict_wall(Ball& ball, std::uint32_t w) {
    const Wall<Real, Dim>& wall = world_.walls()[w];
    const Real gap = dot(wall.normal, ball.x) - wall.offset - ball.radius;
    const Real wait = time_to_close(gap, dot(wall.normal, ball.v), dot(wall.normal, ball.a));
    if (now_ + wait < ball.collision_time) {
      ball.collision_time = now_ + wait;
      ball.partner = first_wall + w;
    }
  }

  void predict_pair(std::uint32_t i, std::uint32_t j) {
    if (i == j || !world_.collide(i, j)) return;
    Ball& ball = balls_[i];
    const Ball& other = balls_[j];
    const Real dt = now_ - other.t;
    const V apart = other.x + other.v * dt + other.a * (dt * dt / 2) - ball.x;
    const V rate = other.v + other.a * dt - ball.v;
    const Real reach = ball.radius + other.radius;
    Real wait;
    if (other.a == ball.a) {
      wait = time_to_touch(apart, rate, reach);
    } else {
      const Real end = std::min({ball.collision_time, ball.crossing_time, std::max(other.crossing_time, now_)});
      if (end == never) return;  // nobody moves
      wait = time_to_touch(apart, rate, Vector<Real, Dim>(other.a - ball.a), reach, Real(end - now_));
      if (wait == never) {
        if (end < ball.collision_time) ball.collision_time = end, ball.partner = look_again;
        return;
      }
    }
    if (now_ + wait < ball.collision_time) {
      ball.collision_time = now_ + wait;
      ball.partner = j;
      ball.collisions_of_partner = other.collisions;
    }
  }

  // Events

  void handle(std::uint32_t i) {
    Ball& ball = balls_[i];
    if (ball.crossing_time <= ball.collision_time) return cross(i);
    if (ball.partner >= first_wall && ball.partner < look_again) return hit_wall(i, ball.partner - first_wall);
    if (ball.partner == look_again || balls_[ball.partner].collisions != ball.collisions_of_partner) {
      ++statistics.outdated;
      return predict(i);
    }
    hit(std::min(i, ball.partner), std::max(i, ball.partner));
  }

  /// Only the bodies of the cells that come into sight are new.
  void cross(std::uint32_t i) {
    ++statistics.crossings;
    Ball& ball = balls_[i];
    grid_.remove(i, ball.cell);
    ball.cell[ball.axis] += ball.direction;
    grid_.insert(i, ball.cell);
    move_to(ball, now_);
    auto lower = ball.cell, upper = ball.cell;
    for (std::size_t axis = 0; axis < lower.size(); ++axis) {
      if (axis == ball.axis) {
        lower[axis] = upper[axis] = ball.cell[axis] + ball.direction;
      } else {
        --lower[axis], ++upper[axis];
      }
    }
    if (ball.partner == look_again) return predict(i);
    ball.crossing_time = never;
    predict_crossing(ball);
    grid_.for_each_in(lower, upper, [&](std::uint32_t j) { predict_pair(i, j); });
    schedule(i);
  }

  bool is_held(const Ball& ball) const { return now_ - ball.last_collision < contact_time_; }

  void note_collision(std::uint32_t i) {
    Ball& ball = balls_[i];
    ++ball.collisions;
    ball.last_collision = now_;
    if (ball.is_resting) {
      ball.is_resting = false;
      ball.a = world_.gravity;
    }
  }

  Mover<Real, Dim> mover(std::uint32_t i) {
    return {balls_[i].v, world_.spin[i], balls_[i].radius, world_.inverse_mass[i], world_.inverse_inertia[i]};
  }
  /// Its orientation at the present, before its spin changes.
  void turn_to_now(std::uint32_t i) {
    if (spun_to_.empty()) spun_to_.assign(balls_.size(), world_.time);
    world_.orientation[i] = turned(world_.orientation[i], world_.spin[i], Real(now_ - spun_to_[i]));
    spun_to_[i] = now_;
  }

  void hit(std::uint32_t i, std::uint32_t j) {
    ++statistics.collisions;
    Ball &a = balls_[i], &b = balls_[j];
    move_to(a, now_);
    move_to(b, now_);
    turn_to_now(i);
    turn_to_now(j);
    Material<Real> material = combined(world_.material[i], world_.material[j]);
    if (is_held(a) || is_held(b)) material.restitution = Real(1);
    const V apart = b.x - a.x;
    const Real distance = length(apart);
    V normal = distance > Real(0) ? apart * (1 / distance) : V{};
    if (!(distance > Real(0))) normal[0] = Real(1);
    if (dot(b.v - a.v, normal) < Real(0)) collide(mover(i), mover(j), normal, material);
    note_collision(i);
    note_collision(j);
    predict(i);
    predict(j);
  }

  void hit_wall(std::uint32_t i, std::uint32_t w) {
    ++statistics.wall_collisions;
    const Wall<Real, Dim>& wall = world_.walls()[w];
    Ball& ball = balls_[i];
    move_to(ball, now_);
    turn_to_now(i);
    Material<Real> material = combined(world_.material[i], wall.material);
    if (is_held(ball)) material.restitution = Real(1);
    V no_velocity{};
    Spin<Real, Dim> no_spin{};
    const Mover<Real, Dim> of_wall{no_velocity, no_spin, Real(0), Real(0), Real(0)};
    if (dot(ball.v, wall.normal) < Real(0)) collide(mover(i), of_wall, V(-wall.normal), material);
    note_collision(i);
    rest_where_it_would_not_leave(ball, wall);
    predict(i);
  }

  /// A flight shorter than the contact time is none.
  void rest_where_it_would_not_leave(Ball& ball, const Wall<Real, Dim>& wall) {
    const Real press = -dot(world_.gravity, wall.normal), speed = dot(ball.v, wall.normal);
    if (!(press > Real(0)) || !(2 * speed < contact_time_ * press)) return;
    ball.v -= wall.normal * speed;
    ball.a = world_.gravity + wall.normal * press;
    ball.is_resting = true;
  }

  World<Real, Dim>& world_;
  ExactOptions<Real> options_;
  Real now_{}, contact_time_{};
  std::vector<Ball> balls_;
  std::vector<std::uint32_t> large_;  // too wide for the cells: everybody's neighbours
  std::vector<Real> spun_to_;         // the time of each orientation
  Grid grid_;
  EventQueue<Real> queue_;
};

template <class Real, int Dim>
ExactMotion<Real, Dim>::ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options)
    : flight_(std::make_unique<Flight>(world, options)) {}
template <class Real, int Dim>
ExactMotion<Real, Dim>::ExactMotion(ExactMotion&&) noexcept = default;
template <class Real, int Dim>
ExactMotion<Real, Dim>& ExactMotion<Real, Dim>::operator=(ExactMotion&&) noexcept = default;
template <class Real, int Dim>
ExactMotion<Real, Dim>::~ExactMotion() = default;
template <class Real, int Dim>
std::string ExactMotion<Real, Dim>::advance_to(const Real& t) {
  return flight_->advance_to(t);
}
template <class Real, int Dim>
void ExactMotion<Real, Dim>::refresh() {
  flight_->refresh();
}
template <class Real, int Dim>
const ExactStatistics& ExactMotion<Real, Dim>::statistics() const {
  return flight_->statistics;
}

template class ExactMotion<float, 2>;
template class ExactMotion<float, 3>;
template class ExactMotion<double, 2>;
template class ExactMotion<double, 3>;

}  // namespace continuo
