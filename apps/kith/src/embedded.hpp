#pragma once

#include <string_view>

// Files that become constants when kith is built.
namespace kith::detail {

// What `kith init` writes, from apps/kith/templates.
extern const std::string_view kBlankDomain;
extern const std::string_view kStudyTemplate;
extern const std::string_view kHumanStudyTemplate;
extern const std::string_view kDemoStudy;
extern const std::string_view kReadmeTemplate;
extern const std::string_view kHumanStudyReadme;
extern const std::string_view kConsentTemplate;
extern const std::string_view kTrialsTemplate;

// What R runs for `kith analyze --model`.
extern const std::string_view kAnalysisScript;

// The pages that show a report, a curriculum and an audit, made from web/; empty if kith was built without pages.
extern const std::string_view kReportPage;
extern const std::string_view kLessonPage;
extern const std::string_view kAuditPage;
// That of a lesson file, with its engine; empty without -DKITH_LESSON=ON.
extern const std::string_view kLessonFilePage;
extern const std::string_view kLessonStudy;

}  // namespace kith::detail
