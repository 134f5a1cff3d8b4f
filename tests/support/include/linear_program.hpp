#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kith/core/assert.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith::testing {

/// Whether `target` is a non-negative combination of `vectors`: phase one of the
/// simplex method with Bland's rule, in integers. Knows nothing of rays. Every
/// entry of the table is a minor of the problem, so small problems stay exact:
/// the division by the previous pivot has no remainder (asserted).
template <typename Integer>
class Combination {
 public:
  Combination(const std::vector<IntegerVector>& vectors, const IntegerVector& target)
      : num_rows_{target.size()}, num_columns_{vectors.size() + target.size() + 1} {
    table_.assign(num_rows_ + 1, std::vector<Integer>(num_columns_, Integer{0}));
    for (std::size_t i = 0; i < num_rows_; ++i) {
      const std::int64_t side = target[i] < 0 ? -1 : 1;
      for (std::size_t j = 0; j < vectors.size(); ++j) table_[i][j] = side * vectors[j][i];
      table_[i][vectors.size() + i] = 1;
      table_[i].back() = side * target[i];
      basis_.push_back(vectors.size() + i);
      for (std::size_t j = 0; j < vectors.size(); ++j) table_.back()[j] -= table_[i][j];
      table_.back().back() -= table_[i].back();
    }
  }

  [[nodiscard]] bool exists() {
    for (std::size_t column = entering(); column + 1 < num_columns_; column = entering()) {
      const std::size_t row = leaving(column);
      KITH_ASSERT(row < num_rows_);  // the sum of the artificial variables is bounded
      pivot(row, column);
    }
    return table_.back().back() == 0;
  }

 private:
  [[nodiscard]] std::size_t entering() const {
    std::size_t j = 0;
    while (j + 1 < num_columns_ && table_.back()[j] >= 0) ++j;
    return j;
  }

  [[nodiscard]] std::size_t leaving(std::size_t column) const {
    std::size_t best = num_rows_;
    for (std::size_t i = 0; i < num_rows_; ++i) {
      if (table_[i][column] <= 0) continue;
      if (best == num_rows_) {
        best = i;
        continue;
      }
      const Integer excess = table_[i].back() * table_[best][column] - table_[best].back() * table_[i][column];
      if (excess < 0 || (excess == 0 && basis_[i] < basis_[best])) best = i;
    }
    return best;
  }

  void pivot(std::size_t row, std::size_t column) {
    const Integer p = table_[row][column];
    for (std::size_t i = 0; i <= num_rows_; ++i) {
      if (i == row) continue;
      const Integer factor = table_[i][column];
      for (std::size_t j = 0; j < num_columns_; ++j) {
        const Integer value = table_[i][j] * p - factor * table_[row][j];
        KITH_ASSERT(value % previous_ == 0);
        table_[i][j] = value / previous_;
      }
    }
    previous_ = p;
    basis_[row] = column;
  }

  std::size_t num_rows_;
  std::size_t num_columns_;
  std::vector<std::vector<Integer>> table_;
  std::vector<std::size_t> basis_;
  Integer previous_ = 1;
};

using WideInteger = boost::multiprecision::int512_t;

/// @tparam Integer WideInteger where entries have more than a few bits.
template <typename Integer = Int128>
bool is_combination(const std::vector<IntegerVector>& vectors, const IntegerVector& target) {
  return Combination<Integer>{vectors, target}.exists();
}

/// Gordan: no interior iff a non-trivial non-negative combination of the normals
/// vanishes, that is iff the opposite of one of them is a combination of all.
inline bool lp_has_interior(const std::vector<IntegerVector>& normals) {
  for (const IntegerVector& c : normals) {
    if (is_combination(normals, -c)) return false;
  }
  return true;
}

/// Farkas: a half-space is redundant iff its normal is a non-negative combination of the others.
inline std::vector<IntegerVector> lp_minimal_set(std::vector<IntegerVector> normals) {
  for (std::size_t i = 0; i < normals.size();) {
    std::vector<IntegerVector> rest = normals;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (is_combination(rest, normals[i])) {
      normals = std::move(rest);
    } else {
      ++i;
    }
  }
  std::sort(normals.begin(), normals.end());
  return normals;
}

}  // namespace kith::testing
