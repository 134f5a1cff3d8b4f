#include "sobol.hpp"

#include <bit>

#include "kith/core/assert.hpp"

namespace kith::detail {
namespace {

// A primitive polynomial over the field of two elements, and the first direction numbers: the first rows of
// the table of Joe and Kuo (a test compares them with those of Boost).
struct Polynomial {
  unsigned degree;
  unsigned coefficients;
  std::array<std::uint32_t, 5> first;
};

constexpr std::array<Polynomial, Sobol::kMaxDimension - 1> kPolynomials{{{1, 0, {1}},
                                                                         {2, 1, {1, 3}},
                                                                         {3, 1, {1, 3, 1}},
                                                                         {3, 2, {1, 1, 1}},
                                                                         {4, 1, {1, 1, 3, 3}},
                                                                         {4, 4, {1, 3, 5, 13}},
                                                                         {5, 2, {1, 1, 5, 5, 17}},
                                                                         {5, 4, {1, 1, 5, 5, 5}}}};

std::array<std::uint32_t, 32> directions_of(const Polynomial& p) {
  std::array<std::uint32_t, 32> v{};
  for (unsigned i = 0; i < 32; ++i) {
    if (i < p.degree) {
      v[i] = p.first[i] << (31 - i);
      continue;
    }
    v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
    for (unsigned k = 1; k < p.degree; ++k) {
      if (((p.coefficients >> (p.degree - 1 - k)) & 1u) != 0) v[i] ^= v[i - k];
    }
  }
  return v;
}

}  // namespace

Sobol::Sobol(const Shift& shift) : bits_{shift} {
  for (unsigned i = 0; i < 32; ++i) directions_[0][i] = std::uint32_t{1} << (31 - i);
  for (std::size_t k = 1; k < kMaxDimension; ++k) directions_[k] = directions_of(kPolynomials[k - 1]);
}

void Sobol::next() {
  if (index_ > 0) {
    const auto changed = static_cast<std::size_t>(std::countr_zero(index_));
    for (std::size_t k = 0; k < kMaxDimension; ++k) bits_[k] ^= directions_[k][changed];
  }
  ++index_;
  KITH_ASSERT(index_ != 0);
}

}  // namespace kith::detail
