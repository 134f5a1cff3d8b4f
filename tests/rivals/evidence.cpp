#include "evidence.hpp"

#include "kith/core/distributions.hpp"

namespace kith::rivals {
namespace {

IntegerVector random_vector(std::int64_t largest, RandomStream& random) {
  IntegerVector v(3);
  while (v.is_zero()) {
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = static_cast<std::int64_t>(uniform_index(static_cast<std::size_t>(2 * largest + 1), random)) - largest;
    }
  }
  return v;
}

std::vector<HalfSpace> around(const IntegerVector& inside, std::size_t n, std::int64_t largest, RandomStream& random) {
  std::vector<HalfSpace> list;
  while (list.size() < n) {
    const auto normal = random_vector(largest, random);
    if (sign_of_dot(normal, inside) > 0) list.emplace_back(normal);
  }
  return list;
}

}  // namespace

Evidence::Evidence(std::size_t n) {
  RandomStream random{1};
  half_spaces = around({1, 2, -4}, n, 4, random);
  for (const auto& h : half_spaces) opposite.push_back(h.opposite());
}

std::vector<HalfSpace> prior_half_spaces() { return {HalfSpace{{0, 0, -1}}}; }

Cone prior_cone() { return Cone::intersection(prior_half_spaces()).value(); }

}  // namespace kith::rivals
