// Nothing of two runs is ever combined, and nothing that is missing goes unsaid.
#include <gtest/gtest.h>

#include "small_study.hpp"

namespace kith::testing {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const Words kSwapped{"--set", "design.strategies=[\"common\",\"baseline\"]"};

void must_run(const Words& words) { expect_code(0, words); }

// Flips a bit inside the record of some team of a journal that is in one file.
void flip_a_bit(const fs::path& journal) {
  auto bytes = text_of(journal);
  const auto record = bytes.rfind("/NP/");  // the seed address, which every record holds
  ASSERT_NE(record, std::string::npos);
  bytes[record] = static_cast<char>(bytes[record] ^ 1);
  std::ofstream{journal, std::ios::binary} << bytes;
}

TEST(Integrity, OfShardsThatWereRunAgainWithAnotherDesign) {
  const Scratch scratch;
  for (const Words& design : {Words{}, kSwapped + Words{"--yes"}}) {
    for (const std::string index : {"1", "2"})
      must_run(small_study(scratch / index) + Words{"--shard", index + "/2"} + design);
  }
  must_run({"merge", scratch / "1", scratch / "2", "-o", scratch / "merged", "-q"});
  must_run(small_study(scratch / "whole") + kSwapped);
  EXPECT_EQ(tables_in(scratch / "merged"), tables_in(scratch / "whole"));
  EXPECT_EQ(text_of(scratch / "merged/inputs/study.toml"), text_of(scratch / "whole/inputs/study.toml"));
}

TEST(Integrity, OfAMergeWithADamagedRecord) {
  const Scratch scratch;
  for (const std::string index : {"1", "2"}) must_run(small_study(scratch / index) + Words{"--shard", index + "/2"});
  flip_a_bit(scratch / "2/study.sqlite");
  const Words merge{"merge", scratch / "1", scratch / "2", "-o", scratch / "merged"};
  const auto refused = err_of(7, merge);
  EXPECT_THAT(refused, AllOf(HasSubstr("error[E0637]"), HasSubstr("shard 2/2"), HasSubstr("the record of team ")));
  EXPECT_FALSE(fs::exists(scratch / "merged"));

  const auto partial = run_kith(merge + Words{"--allow-partial"});
  EXPECT_EQ(partial.code, 6) << partial.err;
  EXPECT_THAT(partial.err, HasSubstr("left out: the record of team "));
  const auto manifest = Json::parse(text_of(scratch / "merged/manifest.json"));
  EXPECT_EQ(manifest.at("exit_reason"), "partial");
  EXPECT_EQ(manifest.at("teams"), 15);
  EXPECT_THAT(run_kith({"analyze", scratch / "merged", "--brief"}).out, HasSubstr("the run is incomplete"));
  must_run({"report", scratch / "merged", "-o", scratch / "report.html"});
  EXPECT_THAT(text_of(scratch / "report.html"), HasSubstr("The run is incomplete"));

  must_run(small_study(scratch / "2") + Words{"--shard", "2/2"});  // teaches that team again
  must_run(merge);
  must_run(small_study(scratch / "whole"));
  EXPECT_EQ(tables_in(scratch / "merged"), tables_in(scratch / "whole"));
}

TEST(Integrity, OfAStudyThatNamesItsLearnersInAnotherOrder) {
  const Scratch scratch;
  must_run(small_study(scratch / "run"));
  auto text = text_of(scratch / "run/inputs/study.toml");
  const auto first = text.find("[learner.N]"), second = text.find("[learner.P]");
  ASSERT_LT(first, second);
  const auto end = text.find("\n[teacher", second) + 1;
  ASSERT_NE(end, 0u);
  text =
      text.substr(0, first) + text.substr(second, end - second) + text.substr(first, second - first) + text.substr(end);
  std::ofstream{scratch / "study.toml"} << text;
  fs::copy_file(scratch / "run/inputs/domain.toml", scratch / "domain.toml");
  must_run({"study", scratch / "study.toml", "-o", scratch / "run", "-q", "--resume", "require"});
}

TEST(Integrity, OfAFolderThatIsMovedDuringARun) {
  const Scratch scratch;
  std::ofstream{scratch / "in"} << "";
  const auto child = start_kith({"study", "quick", "-o", scratch / "run", "--set", "replicates=400", "-q"}, {},
                                scratch / "in", scratch / "out", scratch / "err");
  const fs::path log = scratch / "run/study.sqlite-wal";
  std::error_code none;
  for (int i = 0; i < 6000 && (!fs::exists(log, none) || fs::file_size(log, none) == 0); ++i) usleep(5'000);
  fs::rename(scratch / "run", scratch / "moved");
  EXPECT_EQ(exit_code_of(child), 5);
  EXPECT_THAT(text_of(scratch / "err"), HasSubstr("was moved, removed or replaced"));
  EXPECT_FALSE(fs::exists(scratch / "moved/tables"));
}

// glibc chooses its functions by what the processor can do, which this takes away; results use none of those that round
// otherwise then.
TEST(Integrity, OfMachinesThatRoundDifferently) {
  const Scratch scratch;
  RunWith without_fma;
  without_fma.environment = {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA"}};
  must_run(small_study(scratch / "here"));
  EXPECT_EQ(run_kith(small_study(scratch / "there"), without_fma).code, 0);
  EXPECT_EQ(tables_in(scratch / "here"), tables_in(scratch / "there"));
}

}  // namespace
}  // namespace kith::testing
