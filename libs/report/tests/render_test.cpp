#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kith/report/report.hpp"

namespace kith {
namespace {

const std::string kPage =
    "<title>/*KITH_REPORT_TITLE*/</title><script type=\"application/json\">/*KITH_REPORT_JSON*/</script>";

// What the script element holds.
std::string embedded(const std::string& page) {
  const auto begin = page.find("json\">") + 6;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

TEST(RenderReport, CannotBeEndedByAnyTextOfTheDocument) {
  const nlohmann::json document{{"title", "</script><!-- $& \\ \xE2\x80\xA8\xE2\x80\xA9 \xC3\xA9"}};
  const auto page = render_report(document.dump(), kPage);
  EXPECT_EQ(nlohmann::json::parse(embedded(page)), document);
  EXPECT_EQ(embedded(page).find('<'), std::string::npos);
  EXPECT_EQ(embedded(page).find("\xE2\x80"), std::string::npos);
}

TEST(RenderReport, PutsTheTitleWhereHtmlCannotMistakeIt) {
  const nlohmann::json document{{"title", "a < b & \"c\" /*KITH_REPORT_JSON*/"}};
  EXPECT_THAT(render_report(document.dump(), kPage),
              ::testing::StartsWith("<title>a &lt; b &amp; \"c\" /*KITH_REPORT_JSON*/</title>"));
}

TEST(RenderReport, TakesThePlaceholdersInAnyOrder) {
  EXPECT_EQ(render_report(R"({"title":"t"})", "/*KITH_REPORT_JSON*/|/*KITH_REPORT_TITLE*/"), R"({"title":"t"}|t)");
}

TEST(RenderReport, RefusesPagesAndDocumentsThatItDoesNotKnow) {
  EXPECT_THROW(static_cast<void>(render_report(R"({"title":"t"})", "/*KITH_REPORT_TITLE*/")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(render_report(R"({"title":"t"})", kPage + kPage)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(render_report("[]", kPage)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(render_report("{}", kPage)), std::invalid_argument);
}

}  // namespace
}  // namespace kith
