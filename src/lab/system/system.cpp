#include "lab/system/system.h"

#include "lab/system/laws.h"
#include "lab/system/series.h"
#include "solver/air/force_fields.h"
#include "solver/air/wind.h"

#include <algorithm>
#include <numbers>

namespace hooke::lab {

namespace {

/// Returns the derivative of order `n` of a held point's motion; order 0 is the position.
DVec3 held(const state::Pin& pin, double t, int n) {
  const MotionDesc& motion = pin.motion;
  const double age = t - pin.start_time;
  if (n == 0) return pin.start + solver::motion_offset(motion, age);
  switch (motion.kind) {
    case MotionDesc::Kind::kStill:
      return {};
    case MotionDesc::Kind::kConstantVelocity:
      return n == 1 ? vector_cast<double>(motion.velocity) : DVec3{};
    case MotionDesc::Kind::kSine: {
      const double omega = 2 * std::numbers::pi * static_cast<double>(motion.frequency_hz);
      const double angle = omega * age + static_cast<double>(motion.phase) + n * std::numbers::pi / 2;
      double size = math::sin_cos(angle).sin;
      for (int i = 0; i < n; ++i) size *= omega;
      return size * vector_cast<double>(motion.amplitude);
    }
    case MotionDesc::Kind::kKeyframes:
      break;
  }
  const auto& keys = motion.keyframes;
  const auto after = std::upper_bound(keys.begin(), keys.end(), age,
                                      [](double at, const auto& key) { return at < key.time; });
  if (n > 1 || after == keys.begin() || after == keys.end()) return {};
  const auto before = after - 1;
  return (1 / (after->time - before->time)) *
         (vector_cast<double>(after->offset) - vector_cast<double>(before->offset));
}

/// Returns term `i` of a coordinate: the coefficient of a series, or a double itself.
double& term(double& number, int) {
  return number;
}
template <int N>
double& term(Series<N>& number, int i) {
  return number.c[i];
}

template <class T>
void set_term(Vector3<T>& vector, int i, DVec3 value) {
  term(vector.x, i) = value.x;
  term(vector.y, i) = value.y;
  term(vector.z, i) = value.z;
}

DVec3 point_of(const State& coordinates, Eigen::Index i) {
  return {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
}

State flat(const System& system, const std::vector<DVec3>& of_rows) {
  State result(system.coordinates());
  for (Eigen::Index i = 0; i < system.coordinates() / 3; ++i) {
    const DVec3 a = of_rows[system.row_of_free(i)];
    result.segment<3>(3 * i) = Eigen::Vector3d(a.x, a.y, a.z);
  }
  return result;
}

}  // namespace

State System::initial_state() const {
  State y(2 * coordinates_);
  y << flat(*this, start_x_), flat(*this, start_v_);
  return y;
}

template <class T>
System::Motion<T> System::motion(double t, const std::vector<State>& x_terms,
                                 const std::vector<State>& v_terms) const {
  const std::size_t rows = free_of_row_.size();
  Motion<T> m = {std::vector<Vector3<T>>(rows), std::vector<Vector3<T>>(rows)};
  double factorial = 1;
  for (int i = 0; i < static_cast<int>(x_terms.size()); ++i) {
    factorial *= std::max(i, 1);
    for (std::size_t row = 0; row < rows; ++row) {
      const int free = free_of_row_[row];
      const bool is_held = free == kHeld;
      set_term(m.x[row], i, is_held ? (1 / factorial) * held(pins_[row], t, i) : point_of(x_terms[i], free));
      set_term(m.v[row], i,
               is_held ? (1 / factorial) * held(pins_[row], t, i + 1) : point_of(v_terms[i], free));
    }
  }
  return m;
}

System::Motion<double> System::motion_now(double t, const State& y) const {
  return motion<double>(t, {x(y)}, {v(y)});
}

std::vector<DVec3> System::wind(double t, const std::vector<DVec3>& x) const {
  std::vector<DVec3> wind(x.size());
  if (!feels_air_) return wind;
  for (std::size_t i = 0; i < x.size(); ++i)
    wind[i] = vector_cast<double>(solver::wind_at(wind_, x[i], t, wind_step_));
  return wind;
}

State System::acceleration(double t, const State& y) const {
  ++evaluations_;
  const Motion<double> m = motion_now(t, y);
  std::vector<DVec3> a = accelerations(m, wind(t, m.x));
  if (laws_ != nullptr) {
    std::vector<DVec3> force(a.size());
    laws_->add(t, m.x, m.v, force);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += (1 / mass_[i]) * force[i];
  }
  if (body_laws_ != nullptr) add_body_laws(t, m, a);
  return flat(*this, a);
}

State System::operator()(double t, const State& y) const {
  State slope(y.size());
  slope << v(y), acceleration(t, y);
  return slope;
}

/// Finds one coefficient after the other: those of x and v up to order i give that of a, and so the next of
/// v.
std::vector<State> System::acceleration_and_derivatives(double t, const State& y, int count) const {
  using Term = Series<3>;
  evaluations_ += static_cast<std::uint64_t>(count);
  std::vector<State> x_terms = {x(y)};
  std::vector<State> v_terms = {v(y)};
  std::vector<State> derivatives;
  double factorial = 1;
  for (int i = 0; i < count; ++i) {
    const Motion<Term> m = motion<Term>(t, x_terms, v_terms);
    const std::vector<Vector3<Term>> a = accelerations(m, wind(t, motion_now(t, y).x));
    std::vector<DVec3> coefficient(a.size());
    for (std::size_t row = 0; row < a.size(); ++row)
      coefficient[row] = {a[row].x.c[i], a[row].y.c[i], a[row].z.c[i]};
    const State a_term = flat(*this, coefficient);
    factorial *= std::max(i, 1);
    derivatives.push_back(factorial * a_term);
    x_terms.push_back(v_terms.back() / (i + 1));
    v_terms.push_back(a_term / (i + 1));
  }
  return derivatives;
}

std::vector<DVec3> System::positions(double t, const State& y) const {
  if (is_body()) return body_positions(t, y);
  const Motion<double> m = motion_now(t, y);
  std::vector<DVec3> result;
  for (const std::uint32_t row : row_of_point_) result.push_back(m.x[row]);
  return result;
}

std::vector<DVec3> System::velocities(double t, const State& y) const {
  const Motion<double> m = motion_now(t, y);
  std::vector<DVec3> result;
  for (const std::uint32_t row : row_of_point_) result.push_back(m.v[row]);
  return result;
}

}  // namespace hooke::lab
