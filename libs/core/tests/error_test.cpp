#include "kith/core/error.hpp"

#include <gtest/gtest.h>

#include <type_traits>
#include <unordered_set>

#include "kith/core/assert.hpp"
#include "kith/core/index.hpp"

namespace kith {
namespace {

using AppleIndex = Index<struct Apple>;
using PearIndex = Index<struct Pear>;
static_assert(!std::is_convertible_v<std::size_t, AppleIndex>);
static_assert(!std::is_convertible_v<AppleIndex, std::size_t>);
static_assert(!std::is_constructible_v<AppleIndex, PearIndex>);

TEST(Error, CarriesItsKind) {
  EXPECT_EQ((Error{ErrorKind::kIo, "disk full"}).kind(), ErrorKind::kIo);
  EXPECT_STREQ((Error{ErrorKind::kIo, "disk full"}).what(), "disk full");
  EXPECT_TRUE((Error{ErrorKind::kBusy, "in use"}).diagnostics().empty());
}

TEST(Error, KeepsAdviceApartFromItsMessage) {
  const Error error{ErrorKind::kUsage, "the folder is in use", {"use another one", Remedy::kReplaceContents}};
  EXPECT_STREQ(error.what(), "the folder is in use");
  ASSERT_EQ(error.diagnostics().size(), 1u);
  EXPECT_EQ(error.diagnostics().front().hint, "use another one");
  EXPECT_EQ(error.remedy(), Remedy::kReplaceContents);
  EXPECT_EQ((Error{ErrorKind::kUsage, "no"}).remedy(), Remedy::kNone);
}

TEST(Error, IsInfeasibleOnlyIfEveryErrorIs) {
  const Diagnostic broken{.id = "E1", .message = "broken", .file = "a"};
  const Diagnostic unreachable{.id = "E2", .message = "unreachable", .file = "a", .infeasible = true};
  const Diagnostic warning{.severity = Severity::kWarning, .id = "W1", .message = "odd", .file = "a"};
  EXPECT_EQ(Error{std::vector{broken}}.kind(), ErrorKind::kInvalidInput);
  EXPECT_EQ(Error{std::vector{unreachable}}.kind(), ErrorKind::kInfeasible);
  EXPECT_EQ((Error{std::vector{warning, unreachable}}.kind()), ErrorKind::kInfeasible);
  EXPECT_EQ((Error{std::vector{unreachable, broken}}.kind()), ErrorKind::kInvalidInput);
  EXPECT_EQ(Error{std::vector{warning}}.kind(), ErrorKind::kInvalidInput);
}

TEST(Error, SaysAllItsDiagnostics) {
  const Diagnostic first{.id = "E1", .message = "broken", .file = "a"};
  const Diagnostic second{.id = "E2", .message = "missing", .file = "b"};
  const Error error{std::vector{first, second}};
  EXPECT_STREQ(error.what(), "a: error[E1]: broken\nb: error[E2]: missing");
  EXPECT_EQ(error.diagnostics(), (std::vector{first, second}));
}

TEST(Assert, ThrowsWithItsPlaceInEveryBuild) {
  EXPECT_NO_THROW(KITH_ASSERT(1 + 1 == 2));
  try {
    KITH_ASSERT(1 + 1 == 3);
    FAIL() << "no exception";
  } catch (const std::logic_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("error_test.cpp:"), std::string::npos) << text;
    EXPECT_NE(text.find("1 + 1 == 3"), std::string::npos) << text;
  }
}

TEST(Index, ComparesCountsAndHashesByValue) {
  AppleIndex i{3};
  EXPECT_LT(AppleIndex{2}, i);
  EXPECT_EQ(++i, AppleIndex{4});
  EXPECT_EQ(AppleIndex{}.value(), 0u);
  EXPECT_EQ((std::unordered_set<AppleIndex>{AppleIndex{1}, AppleIndex{2}, AppleIndex{1}}.size()), 2u);
}

}  // namespace
}  // namespace kith
