#include "kith/files/table_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "kith/core/error.hpp"
#include "scratch_folder.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

struct Refusal {
  ErrorKind kind = ErrorKind::kUsage;
  std::string id, message;
};

template <typename Reading>
Refusal refusal_of(Reading reading) {
  try {
    static_cast<void>(reading());
  } catch (const Error& error) {
    return {error.kind(), error.diagnostics().empty() ? "" : error.diagnostics().front().id, error.what()};
  }
  return {};
}

class TableText : public ::testing::Test {
 protected:
  testing::ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
};

TEST_F(TableText, IsThatOfTheFile) {
  const auto text = "a,b\n" + std::string(3'000'000, '1') + ",2\n";
  std::ofstream{folder_ / "table.csv"} << text;
  EXPECT_EQ(read_table_text(folder_ / "table.csv"), text);
  std::istringstream stream{text};
  EXPECT_EQ(read_table_text(stream, "<stdin>"), text);
}

TEST_F(TableText, SaysWhyAFileCannotBeRead) {
  const auto missing = refusal_of([&] { return read_table_text(folder_ / "missing.csv"); });
  EXPECT_EQ(missing.kind, ErrorKind::kIo);
  EXPECT_THAT(missing.message, HasSubstr("No such file"));
  const auto folder = refusal_of([&] { return read_table_text(folder_); });
  EXPECT_EQ(folder.kind, ErrorKind::kIo);
  EXPECT_THAT(folder.message, HasSubstr("Is a directory"));
}

TEST_F(TableText, OfAFileThatIsTooLargeIsNotRead) {
  std::ofstream{folder_ / "large.csv"} << "a\n";
  fs::resize_file(folder_ / "large.csv", 5'100'000'000);  // a hole, which takes no space
  const auto refusal = refusal_of([&] { return read_table_text(folder_ / "large.csv"); });
  EXPECT_EQ(refusal.kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(refusal.id, "E0513");
  EXPECT_THAT(refusal.message, HasSubstr("the table has 5.1 GB; at most 4 GB are read"));
}

TEST_F(TableText, OfAFileThatDoesNotFitIntoMemoryIsNotRead) {
  std::ofstream{folder_ / "large.csv"} << "a\n";
  fs::resize_file(folder_ / "large.csv", 3'000'000'000);
  setenv("KITH_MEMORY", "1G", 1);
  const auto refusal = refusal_of([&] { return read_table_text(folder_ / "large.csv"); });
  unsetenv("KITH_MEMORY");
  EXPECT_EQ(refusal.kind, ErrorKind::kInfeasible);
  EXPECT_EQ(refusal.id, "E1201");
  EXPECT_THAT(refusal.message, AllOf(HasSubstr("needs about 3 GB of memory"), HasSubstr("large.csv")));
}

// Gives bytes for ever.
class Endless : public std::streambuf {
 public:
  explicit Endless(char c) : piece_(1 << 16, c) {}

 protected:
  int_type underflow() override {
    setg(piece_.data(), piece_.data(), piece_.data() + piece_.size());
    return traits_type::to_int_type(piece_.front());
  }

 private:
  std::string piece_;
};

TEST_F(TableText, ThatNeverEndsIsGivenUp) {
  setenv("KITH_MEMORY", "100M", 1);
  Endless ones{'1'};
  std::istream pipe{&ones};
  const auto refusal = refusal_of([&] { return read_table_text(pipe, "<stdin>"); });
  unsetenv("KITH_MEMORY");
  EXPECT_EQ(refusal.id, "E1201");
  EXPECT_THAT(refusal.message, HasSubstr("reading <stdin>"));
}

TEST_F(TableText, EndsAtAZeroByte) {
  Endless zeros{'\0'};
  std::istream device{&zeros};
  EXPECT_LE(read_table_text(device, "/dev/zero").size(), std::size_t{1} << 20U);
}

TEST(TableTextSlow, ThatNeverEndsIsGivenUpAfterItsLimit) {
  Endless ones{'1'};
  std::istream pipe{&ones};
  const auto refusal = refusal_of([&] { return read_table_text(pipe, "<stdin>"); });
  EXPECT_EQ(refusal.kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(refusal.id, "E0513");
  EXPECT_THAT(refusal.message, HasSubstr("at most 500 MB are read"));
}

}  // namespace
}  // namespace kith
