#include "kith/files/generation.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/folder_lock.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using Content = std::map<std::string, std::string>;

class GenerationTest : public ::testing::Test {
 protected:
  GenerationTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "inputs");
    put(folder_, "inputs/study", "old");
    put(folder_, "manifest", "old");
    put(folder_, "mine.txt", "not of any generation");
  }
  ~GenerationTest() override { fs::remove_all(folder_); }

  static void put(const fs::path& folder, const std::string& name, const std::string& text) {
    fs::create_directories((folder / name).parent_path());
    std::ofstream{folder / name} << text;
  }
  [[nodiscard]] Content content() const {
    Content files;
    for (const auto& entry : fs::recursive_directory_iterator{folder_}) {
      if (entry.is_regular_file()) files[fs::relative(entry.path(), folder_).string()] = read_file(entry.path());
    }
    return files;
  }
  // A new generation that has no tables, so those that are there go.
  void commit() const {
    Generation generation{folder_};
    put(generation.path(), "inputs/study", "new");
    put(generation.path(), "inputs/more", "new");
    put(generation.path(), "manifest", "new");
    generation.commit({"tables"});
  }

  const Content before_{{"inputs/study", "old"}, {"manifest", "old"}, {"mine.txt", "not of any generation"}};
  const Content after_{
      {"inputs/study", "new"}, {"inputs/more", "new"}, {"manifest", "new"}, {"mine.txt", "not of any generation"}};
  fs::path folder_ =
      fs::path{::testing::TempDir()} /
      ("kith generation " + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
};

TEST_F(GenerationTest, ChangesNothingUntilItIsCommitted) {
  {
    Generation generation{folder_};
    put(generation.path(), "manifest", "new");
  }
  EXPECT_EQ(content(), before_);
}

TEST_F(GenerationTest, ReplacesWhatItHoldsAndRemovesWhatItIsToldTo) {
  put(folder_, "tables/teams", "old");
  commit();
  EXPECT_EQ(content(), after_);
}

TEST_F(GenerationTest, IsNotFinishedByReadersWhileItsOwnerIsAtIt) {
  const auto lock = FolderLock::try_acquire(folder_);
  ASSERT_TRUE(lock);
  EXPECT_FALSE(FolderLock::try_acquire(folder_));
  EXPECT_TRUE(is_busy(folder_));
  fs::create_directory(folder_ / ".kith-committed");
  EXPECT_THROW(settle_for_reading(folder_), Error);
}

TEST_F(GenerationTest, RemovesWhatEndedProgramsLeft) {
  put(folder_, ".kith-staging-1/manifest", "half");
  { const Generation generation{folder_}; }
  EXPECT_EQ(content(), before_);
}

TEST_F(GenerationTest, ReplacesALinkAndNotWhatItLeadsTo) {
  const auto victim = fs::path{::testing::TempDir()} / "kith generation victim";
  std::ofstream{victim} << "precious";
  fs::remove(folder_ / "manifest");
  fs::create_symlink(victim, folder_ / "manifest");
  commit();
  EXPECT_EQ(read_file(victim), "precious");
  EXPECT_EQ(content(), after_);
  fs::remove(victim);
}

TEST(FolderLock, KnowsWhetherTheFolderIsStillThere) {
  const auto folder = fs::path{::testing::TempDir()} / "kith folder lock";
  fs::remove_all(folder);
  fs::create_directories(folder / "here");
  const auto lock = FolderLock::try_acquire(folder / "here");
  ASSERT_TRUE(lock);
  EXPECT_TRUE(lock->is_at(folder / "here"));
  fs::rename(folder / "here", folder / "there");
  EXPECT_FALSE(lock->is_at(folder / "here"));
  fs::create_directory(folder / "here");
  EXPECT_FALSE(lock->is_at(folder / "here"));
  EXPECT_TRUE(lock->is_at(folder / "there"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace kith
