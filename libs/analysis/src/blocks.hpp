#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace kith {

// Values in blocks that have every level of a factor once, such as teams of the same people.
struct Blocks {
  std::vector<std::vector<double>> rows;  // [blocks][levels], less the block's mean
  std::vector<std::size_t> group;         // [blocks], level of the factor between blocks
};

// What the blocks' means leave, split into the factor, its interaction with the groups, and the rest.
struct BlockSpread {
  double of_within = 0.0;
  double of_interaction = 0.0;
  double residual = 0.0;
  std::vector<std::vector<double>> expected;  // [groups][levels]
  std::vector<std::size_t> sizes;             // [groups], blocks in each
};
[[nodiscard]] BlockSpread spread_of(const Blocks& blocks, std::size_t num_groups);

// Takes its mean from a row, and returns it.
double subtract_mean(std::vector<double>& row);

// Covariances of the levels less the blocks' means, within groups, times their degrees of freedom: of rank levels - 1,
// with the eigenvalues that orthonormal contrasts of the levels have.
[[nodiscard]] Eigen::MatrixXd covariances_of(const Blocks& blocks, const BlockSpread& spread);
// Greenhouse's and Geisser's epsilon of them, in [1 / (levels - 1), 1]; 1 without any spread.
[[nodiscard]] double greenhouse_geisser(const Eigen::MatrixXd& covariances);

}  // namespace kith
