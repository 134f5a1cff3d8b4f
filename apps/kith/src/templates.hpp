#pragma once

#include <string_view>

namespace kith::detail {

// The files that `kith init` writes, from apps/kith/templates, embedded when kith was built.
extern const std::string_view kBlankDomain;
extern const std::string_view kStudyTemplate;
extern const std::string_view kHumanStudyTemplate;
extern const std::string_view kDemoStudy;
extern const std::string_view kReadmeTemplate;
extern const std::string_view kHumanStudyReadme;
extern const std::string_view kConsentTemplate;

}  // namespace kith::detail
