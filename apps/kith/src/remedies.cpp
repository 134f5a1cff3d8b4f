#include "remedies.hpp"

#include <string_view>

namespace kith::cli {
namespace {

std::string_view words_for(Remedy remedy) {
  switch (remedy) {
    case Remedy::kNone:
      return {};
    case Remedy::kReplaceContents:
      return "choose another folder, or add --yes to replace what is in this one";
    case Remedy::kStartOver:
      return "start the study over with --resume never";
    case Remedy::kAllowStart:
      return "leave out --resume require to start the study from the beginning";
    case Remedy::kRunStudy:
      return "make one with: kith study STUDY -o DIR";
    case Remedy::kRunShard:
      return "make one with: kith study STUDY --shard I/N -o DIR";
    case Remedy::kMergeShards:
      return "merge all shards with: kith merge DIR... -o DIR";
    case Remedy::kMergePart:
      return "merge what is available with --allow-partial";
    case Remedy::kAnalyseTable:
      return "analyse a table of your own with: kith analyze FILE --model ...";
    case Remedy::kLikelihoodMethod:
      return "use --method likelihood";
  }
  return {};
}

}  // namespace

std::vector<Diagnostic> with_remedies(std::vector<Diagnostic> diagnostics) {
  for (auto& one : diagnostics) {
    const auto words = words_for(one.remedy);
    if (words.empty()) continue;
    if (!one.hint.empty()) one.hint += "; or ";
    one.hint += words;
    one.remedy = Remedy::kNone;
  }
  return diagnostics;
}

}  // namespace kith::cli
