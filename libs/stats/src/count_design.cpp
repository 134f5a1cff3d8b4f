#include "count_design.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

namespace kith::detail {
namespace {

// Whether the span of the columns of `rows` has a vector v >= 0 other than 0. Projections by turns onto the span and
// onto the vectors >= 0 never lose any of u'v, which is sum(v) >= |v| at the start u = 1: if |u| falls below 1 there is
// no such v, and if there is none, u tends to 0.
bool span_has_a_non_negative_vector(const Eigen::MatrixXd& rows) {
  constexpr int kMostTurns = 100'000;
  constexpr double kRounding = 1e-9;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr{rows};
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(rows.rows(), rows.cols());
  Eigen::VectorXd u = Eigen::VectorXd::Ones(rows.rows());
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Eigen::VectorXd projected = basis * (basis.transpose() * u);
    u = projected.cwiseMax(0.0);
    if (u.norm() < 1.0 - kRounding) return false;
    if (projected.minCoeff() > -kRounding) return true;
  }
  return true;
}

}  // namespace

CountData count_data_of(std::span<const double> counts, const FactorDesign& design) {
  CountData data;
  std::vector<std::size_t> row_of(design.counts.size(), 0);
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    if (design.counts[c] == 0) continue;
    row_of[c] = data.cells.size();
    data.cells.emplace_back();
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    auto& cell = data.cells[row_of[design.cell_of[i]]];
    cell.observations += 1.0;
    cell.sum += counts[i];
    data.sum += counts[i];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    auto& cell = data.cells[row_of[design.cell_of[i]]];
    const double deviation = counts[i] - cell.sum / cell.observations;
    cell.squares += deviation * deviation;
  }
  data.observations = static_cast<double>(counts.size());
  return data;
}

CountDesign count_design_of(const FactorDesign& design) {
  CountDesign result{{}, static_cast<Eigen::Index>(design.kept.size())};
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    if (design.counts[c] == 0) continue;
    auto& columns = result.columns.emplace_back();
    for (std::size_t k = 0; k < design.kept.size(); ++k) {
      if (design.grid[c * design.columns.size() + design.kept[k]] != 0.0)
        columns.push_back(static_cast<Eigen::Index>(k));
    }
  }
  return result;
}

bool zeros_separate(const CountData& data, const CountDesign& design) {
  const auto is_positive = [](const CountCell& cell) { return cell.sum > 0.0; };
  const Eigen::FullPivLU<Eigen::MatrixXd> products{products_over(data, design, is_positive)};
  if (products.dimensionOfKernel() == 0) return false;
  const Eigen::MatrixXd directions = products.kernel();
  const auto num_zeros = std::ranges::count_if(data.cells, std::not_fn(is_positive));
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(num_zeros), directions.cols());
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    if (is_positive(data.cells[c])) continue;
    for (const auto column : design.columns[c]) rows.row(row) += directions.row(column);
    ++row;
  }
  return span_has_a_non_negative_vector(rows);
}

double pearson_dispersion(const CountData& data, const CountDesign& design, const CountFit& poisson) {
  const Eigen::VectorXd mu = linear_predictor(design, poisson.coefficients).array().exp();
  double chi_squared = 0.0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const double mu_c = mu[static_cast<Eigen::Index>(c)];
    const double off = cell.sum / cell.observations - mu_c;
    chi_squared += (cell.squares + cell.observations * off * off) / mu_c;
  }
  return chi_squared / (data.observations - static_cast<double>(design.size));
}

}  // namespace kith::detail
