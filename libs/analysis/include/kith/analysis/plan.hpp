#pragma once

#include <string>
#include <vector>

#include "kith/analysis/analysis.hpp"

namespace kith {

/// What is known of a study before it is run.
struct PlannedDesign {
  std::vector<std::string> strategies;       ///< As in the study file, with the baseline.
  std::vector<std::string> compositions;     ///< None twice, as strategies.
  bool same_people = true;                   ///< Whether every strategy teaches the same people.
  std::vector<PlannedContrast> contrasts{};  ///< The [[contrast]]s of the study file.
  bool has_exam = false;                     ///< Whether teams are examined outside the lessons.
};

/// One analysis of analyze_run() before there are data.
struct PlannedAnalysis {
  std::string id;        ///< Of its finding.
  std::string title;     ///< Of its finding.
  std::string question;  ///< Of its finding.
  std::string model;     ///< Of its finding.
  std::vector<Method> methods;
  std::vector<PlannedContrast> contrasts;  ///< Of the study file that it tests.
};

/// Hypotheses of a study: every primary contrast, about one outcome each; in the order in which they are tested.
[[nodiscard]] std::vector<PlannedContrast> primary_hypotheses(const PlannedDesign& design);

/// The analyses that analyze_run() will make of a study of this design, in its order, as long as all teams finish. They
/// come from the same code: it analyses teams made up of random numbers, and only questions, models and methods are
/// kept. Settings that vary, and the manipulation check, are left out.
/// @throws std::invalid_argument without strategies or compositions.
[[nodiscard]] std::vector<PlannedAnalysis> planned_analyses(const PlannedDesign& design,
                                                            const AnalysisOptions& options);

}  // namespace kith
