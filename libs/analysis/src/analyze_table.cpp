#include "kith/analysis/analysis.hpp"
#include "kith/analysis/exports.hpp"
#include "prepared_model.hpp"

namespace kith {

Analysis analyze_table(const Dataset& data, const ModelQuestion& question, const AnalysisOptions& options) {
  const auto prepared = prepare_model(data, question, options);
  Analysis analysis{data.file(), prepared.notes};
  auto finding = analyze_model(prepared.model, options, RandomStream{options.seed}.split("model"));
  finding.warnings.insert(finding.warnings.begin(), prepared.warnings.begin(), prepared.warnings.end());
  finding.results = results_paragraph(finding, options.alpha);
  analysis.findings.push_back(std::move(finding));
  return analysis;
}

}  // namespace kith
