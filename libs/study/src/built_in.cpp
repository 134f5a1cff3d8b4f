#include "built_in.hpp"

#include "kith/study/study_file.hpp"

namespace kith {

const std::vector<BuiltInStudy>& built_in_studies() {
  static const std::vector<BuiltInStudy> kStudies{{"paper", detail::kPaperText},
                                                  {"paper-uncalibrated", detail::kPaperUncalibratedText},
                                                  {"quick", detail::kQuickText}};
  return kStudies;
}

}  // namespace kith
