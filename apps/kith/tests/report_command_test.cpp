#include <gtest/gtest.h>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::IsEmpty;

// A finished run, made once.
class ReportCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new Scratch;
    ASSERT_EQ(run_kith({"study", "quick", "-o", *scratch_ / "run", "-q"}).code, 0);
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string folder() { return *scratch_ / "run"; }
  static Scratch* scratch_;
};
Scratch* ReportCommand::scratch_ = nullptr;

// The document inside a page.
Json document_in(const std::string& page) {
  const std::string begin{"<script type=\"application/json\" id=\"kith-document\">"};
  const auto at = page.find(begin) + begin.size();
  return Json::parse(page.substr(at, page.find("</script>", at) - at), nullptr, false);
}

TEST_F(ReportCommand, WritesAPageIntoTheFolderAndSaysWhere) {
  const auto ran = run_kith({"report", folder()});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, IsEmpty());
  EXPECT_THAT(ran.err, HasSubstr("report in " + folder() + "/report.html"));
  const auto page = text_of(folder() + "/report.html");
  EXPECT_THAT(
      page, AllOf(HasSubstr("<title>A first look: two strategies, six teams</title>"), Not(HasSubstr("KITH_REPORT_"))));
  EXPECT_EQ(document_in(page).at("schema"), "kith.report/1");
}

TEST_F(ReportCommand, WritesThePageWhereItIsTold) {
  EXPECT_EQ(run_kith({"report", folder(), "-o", *scratch_ / "page.html", "-q"}).err, "");
  const auto page = run_kith({"report", folder(), "-o", "-"});
  EXPECT_EQ(page.out, text_of(*scratch_ / "page.html"));
  EXPECT_THAT(page.err, IsEmpty());
}

TEST_F(ReportCommand, PrintsTheDocumentInstead) {
  const auto ran = run_kith({"report", folder(), "--json"});
  EXPECT_EQ(Json::parse(ran.out), document_in(run_kith({"report", folder(), "-o", "-"}).out));
}

TEST_F(ReportCommand, FailsWithTheCodeAndTheIdOfTheFault) {
  EXPECT_EQ(run_kith({"report"}).code, 2);
  const auto missing = err_of(5, {"report", *scratch_ / "nowhere"});
  EXPECT_THAT(missing, AllOf(HasSubstr("nowhere: error[E0601]: "), HasSubstr("kith study STUDY -o DIR")));
  std::filesystem::create_directories(*scratch_ / "empty");
  const auto empty = run_kith({"report", *scratch_ / "empty", "--json"});
  EXPECT_EQ(empty.code, 3);
  EXPECT_EQ(Json::parse(empty.out).at("errors").at(0).at("id"), "E0602");
}

TEST_F(ReportCommand, FailsWhereItCannotWrite) {
  EXPECT_EQ(run_kith({"report", folder(), "-o", *scratch_ / "no/such/page.html"}).code, 5);
  EXPECT_EQ(run_kith({"report", folder(), "-o", "-"}, {{}, "", "/dev/full"}).code, 5);
}

}  // namespace
}  // namespace kith::testing
