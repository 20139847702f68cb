#include "geometry/orientation.h"

#include <array>
#include <cmath>

namespace hooke::geometry {

namespace {

constexpr double kRounding = 0x1p-53;

/// A sum without rounding: `head` is the rounded value, `tail` the rest.
struct Pair {
  double head = 0;
  double tail = 0;
};

/// Knuth's sum.
Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_in_sum = sum - a;
  return {sum, (a - (sum - b_in_sum)) + (b - b_in_sum)};
}

/// Dekker's product of numbers cut in halves of 26 bits.
Pair two_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const auto split = [](double value) -> Pair {
    const double big = kSplitter * value;
    const double head = big - (big - value);
    return {head, value - head};
  };
  const double product = a * b;
  const Pair x = split(a);
  const Pair y = split(b);
  const double rest = ((x.head * y.head - product) + x.head * y.tail + x.tail * y.head) + x.tail * y.tail;
  return {product, rest};
}

/// A number as the sum of doubles that do not overlap, the smallest first.
class Expansion {
 public:
  /// Shewchuk's grow-expansion; terms of zero are left out.
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Pair sum = two_sum(value, term_[i]);
      value = sum.head;
      if (sum.tail != 0) term_[kept++] = sum.tail;
    }
    if (value != 0) term_[kept++] = value;
    count_ = kept;
  }
  /// Adds the product of the term by `factor`.
  void add_product(double term, double factor) {
    const Pair product = two_product(term, factor);
    add(product.tail);
    add(product.head);
  }
  /// Adds the product of a number by a pair.
  void add_product(const Expansion& number, Pair factor) {
    for (std::size_t i = 0; i < number.count_; ++i) {
      if (factor.tail != 0) add_product(number.term_[i], factor.tail);
      add_product(number.term_[i], factor.head);
    }
  }
  [[nodiscard]] int sign() const { return count_ == 0 ? 0 : term_[count_ - 1] > 0 ? 1 : -1; }

 private:
  /// Six products of three pairs are the most: 6 x 2^3 products of two, of three factors.
  std::array<double, 200> term_;
  std::size_t count_ = 0;
};

/// a - b without rounding.
Pair difference(double a, double b) {
  return two_sum(a, -b);
}

Expansion product(Pair a, Pair b) {
  Expansion result;
  Expansion first;
  first.add(a.tail);
  first.add(a.head);
  result.add_product(first, b);
  return result;
}

struct PairVector {
  Pair x, y, z;
};

PairVector difference(DVec3 a, DVec3 b) {
  return {difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z)};
}

Pair negated(Pair a) {
  return {-a.head, -a.tail};
}

int exact_orientation(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const PairVector u = difference(b, a);
  const PairVector v = difference(c, a);
  const PairVector w = difference(d, a);
  Expansion sum;
  sum.add_product(product(u.y, v.z), w.x);
  sum.add_product(product(negated(u.z), v.y), w.x);
  sum.add_product(product(u.z, v.x), w.y);
  sum.add_product(product(negated(u.x), v.z), w.y);
  sum.add_product(product(u.x, v.y), w.z);
  sum.add_product(product(negated(u.y), v.x), w.z);
  return sum.sign();
}

int exact_orientation(Point2 a, Point2 b, Point2 c) {
  const auto expansion_of = [](Pair pair) {
    Expansion number;
    number.add(pair.tail);
    number.add(pair.head);
    return number;
  };
  Expansion sum;
  sum.add_product(expansion_of(difference(b.x, a.x)), difference(c.y, a.y));
  sum.add_product(expansion_of(negated(difference(b.y, a.y))), difference(c.x, a.x));
  return sum.sign();
}

/// Whether the error of `value`, at most `bound`, leaves its sign certain.
bool is_certain(double value, double bound) {
  return value > bound || value < -bound;
}

}  // namespace

int orientation(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 u = b - a;
  const DVec3 v = c - a;
  const DVec3 w = d - a;
  const double value = dot(cross(u, v), w);
  const auto size = [](double p, double q) { return std::fabs(p) + std::fabs(q); };
  const double size_sum = size(u.y * v.z, u.z * v.y) * std::fabs(w.x) +
                          size(u.z * v.x, u.x * v.z) * std::fabs(w.y) +
                          size(u.x * v.y, u.y * v.x) * std::fabs(w.z);
  // This is Shewchuk's bound for this order of operations.
  if (is_certain(value, (7 + 56 * kRounding) * kRounding * size_sum)) return value > 0 ? 1 : -1;
  if (!std::isfinite(value)) return 0;
  return exact_orientation(a, b, c, d);
}

int orientation(Point2 a, Point2 b, Point2 c) {
  const double left = (b.x - a.x) * (c.y - a.y);
  const double right = (b.y - a.y) * (c.x - a.x);
  const double value = left - right;
  const double bound = (3 + 16 * kRounding) * kRounding * (std::fabs(left) + std::fabs(right));
  if (is_certain(value, bound)) return value > 0 ? 1 : -1;
  if (!std::isfinite(value)) return 0;
  return exact_orientation(a, b, c);
}

}  // namespace hooke::geometry
