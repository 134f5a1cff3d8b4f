#include "kith/bec/grade_table.hpp"

#include <algorithm>

#include "kith/domains/judgement.hpp"

namespace kith {

GradeTable::GradeTable(const Atlas& atlas)
    : num_components_{atlas.knowledge_components().size()}, num_hulls_{atlas.tables().num_hulls()} {
  grade_starts(atlas);
  grade_tests(atlas);
}

void GradeTable::grade_starts(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  const auto& tables = atlas.tables();
  // How many starts of each component, and of all, are the same question.
  const std::size_t columns = num_components_ + 1;
  std::vector<double> counts(num_hulls_ * columns, 0.0);
  std::vector<double> totals(columns, 0.0);
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    for (std::size_t k = 0; k < columns; ++k) {
      if (k < num_components_ && !atlas.knowledge_components()[k].uses_mdp[atlas.id(start).mdp.value()]) continue;
      counts[tables.hull(start).value() * columns + k] += 1.0;
      totals[k] += 1.0;
    }
  }

  const std::size_t num_cells = tables.cells().size();
  const IntegerVector nothing(domain.num_features());
  right_.assign(num_cells * num_hulls_, 0);
  grades_.assign(num_cells * columns, {});
  for (std::size_t h = 0; h < num_hulls_; ++h) {
    std::vector<PathJudgement> judged;  // one per vertex of the coverage set
    double worst = 0.0;
    for (const auto& loss : tables.hull(HullIndex{h}).losses) {
      judged.push_back(judge_path(domain, loss, nothing));
      worst = std::max(worst, judged.back().raw_regret);
    }
    for (std::size_t cell = 0; cell < num_cells; ++cell) {
      const auto choice = tables.cells().choice(PolicyCellIndex{cell}, HullIndex{h});
      const bool is_right = choice != PolicyCells::kNone && judged[choice].is_right;
      const double regret = choice == PolicyCells::kNone ? worst : judged[choice].raw_regret;
      right_[cell * num_hulls_ + h] = is_right ? 1 : 0;
      for (std::size_t k = 0; k < columns; ++k) {
        auto& grade = grades_[cell * columns + k];
        grade.share_right += is_right ? counts[h * columns + k] : 0.0;
        grade.regret += regret * counts[h * columns + k];
      }
    }
  }

  for (std::size_t i = 0; i < grades_.size(); ++i) {
    const double total = std::max(totals[i % columns], 1.0);
    grades_[i].share_right /= total;
    grades_[i].regret /= total;
  }
}

void GradeTable::grade_tests(const Atlas& atlas) {
  const auto& tables = atlas.tables();
  tests_.resize(num_components_);
  for (std::size_t k = 0; k < num_components_; ++k) {
    const auto& component = atlas.knowledge_components()[k];
    std::vector<double> weights(num_hulls_, 0.0);
    double num_facets = 0.0;  // that something tests
    for (const auto facet : component.constraints.members()) {
      std::vector<HullIndex> hulls;
      for (const auto start : atlas.tests_for(facet)) {
        if (component.uses_mdp[atlas.id(start).mdp.value()]) hulls.push_back(tables.hull(start));
      }
      if (hulls.empty()) continue;
      num_facets += 1.0;
      for (const auto hull : hulls) weights[hull.value()] += 1.0 / static_cast<double>(hulls.size());
    }
    for (std::size_t h = 0; h < num_hulls_; ++h) {
      if (weights[h] > 0.0) tests_[k].push_back({HullIndex{h}, weights[h] / num_facets});
    }
  }
}

}  // namespace kith
