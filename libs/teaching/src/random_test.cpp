#include "kith/teaching/random_test.hpp"

#include <algorithm>

namespace kith {

RandomTest::RandomTest(const Atlas& atlas, const Exam& exam, std::size_t component)
    : atlas_{&atlas}, table_{exam.table()}, component_{component} {
  if (table_) {
    for (const auto& test : table_->tests(component)) weights_.push_back(test.weight);
    return;
  }
  facets_ = atlas.constraints().half_spaces(atlas.knowledge_components()[component].constraints);
  weights_.assign(facets_.size(), 1.0 / static_cast<double>(facets_.size()));
}

std::vector<double> RandomTest::right_in_cells(std::span<const double> masses) const {
  std::vector<double> right;
  for (const auto& test : table_->tests(component_)) {
    double sum = 0.0;
    for (std::size_t c = 0; c < masses.size(); ++c) {
      if (table_->is_right(PolicyCellIndex{c}, test.hull)) sum += masses[c];
    }
    right.push_back(sum);
  }
  return right;
}

std::vector<double> RandomTest::right(const ParticleBelief& belief) const {
  if (!table_) {
    std::vector<double> right;
    for (const auto& facet : facets_) right.push_back(belief.mass_in({&facet, 1}));
    return right;
  }
  const auto& cells = atlas_->tables().cells();
  std::vector<double> masses(cells.size(), 0.0);
  const auto weights = belief.weights();
  const auto numbers = cells.locate(belief.x(), belief.y(), belief.z());
  for (std::size_t i = 0; i < weights.size(); ++i) masses[numbers[i]] += weights[i];
  return right_in_cells(masses);
}

std::vector<double> RandomTest::right(LearnerBank& bank, double stopping) const {
  if (table_) return right_in_cells(bank.cell_masses(*atlas_, stopping));
  std::vector<double> right;
  for (const auto& facet : facets_) right.push_back(bank.mass_in({&facet, 1}));
  return right;
}

double RandomTest::all_right(std::span<const std::vector<double>> people) const {
  double expected = 0.0;
  for (std::size_t t = 0; t < weights_.size(); ++t) {
    std::vector<double> right;
    for (const auto& person : people) right.push_back(person[t]);
    std::sort(right.begin(), right.end());  // so that seats do not matter
    double all = 1.0;
    for (const double p : right) all *= p;
    expected += weights_[t] * all;
  }
  return expected;
}

}  // namespace kith
