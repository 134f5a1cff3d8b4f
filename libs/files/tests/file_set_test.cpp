#include "kith/files/file_set.hpp"

#include <gtest/gtest.h>

#include "scratch_folder.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator{folder}) {
    if (entry.is_regular_file()) files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  }
  return files;
}

TEST(FileSet, ReplacesItsFilesTogetherAndLeavesOthersAlone) {
  const ScratchFolder scratch;
  const auto folder = scratch / "out";
  fs::create_directories(folder / "notes");
  write_file_atomically(folder / "a", "old a");
  write_file_atomically(folder / "b", "old b");
  write_file_atomically(folder / "notes" / "mine", "mine");
  FileSet set{folder};
  set.write("a", "new ");
  set.write("a", "a");
  set.write("c", "new c");
  EXPECT_EQ(read_file(folder / "a"), "old a");
  set.commit({"a", "b", "d"});
  EXPECT_EQ(contents(folder),
            (std::map<std::string, std::string>{{"a", "new a"}, {"c", "new c"}, {"notes/mine", "mine"}}));
}

// Whatever people call the folder.
TEST(FileSet, KnowsAFolderByAllOfItsNames) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "out");
  fs::create_directory_symlink("out", scratch / "link");
  int round = 0;
  for (const std::string name : {"out", "out/", "out/.", "out//", "./out/./", "link", "link/"}) {
    FileSet set{fs::path{(scratch / "").string() + name}};
    set.write("a", std::to_string(++round));
    set.commit();
    EXPECT_EQ(contents(scratch / "out"), (std::map<std::string, std::string>{{"a", std::to_string(round)}})) << name;
  }
  EXPECT_TRUE(fs::is_symlink(scratch / "link"));
  for (const std::string name : {"new/", "deep/er/", "dot/."}) {
    {
      FileSet set{fs::path{(scratch / "").string() + name}};
      set.write("a", "x");
      set.commit();
    }
    EXPECT_EQ(contents(scratch / name), (std::map<std::string, std::string>{{"a", "x"}})) << name;
  }
}

TEST(FileSet, TakesTheNameOfNothingButAFile) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "folder");
  write_file_atomically(scratch / "folder" / "thesis", "years of work");
  fs::create_symlink("nowhere/at/all", scratch / "dangling");
  fs::create_symlink("folder/thesis", scratch / "link");
  const auto before = contents(scratch / ".");
  for (const auto* name : {"folder", "dangling", "link"}) {
    FileSet set{scratch / "."};
    set.write("new", "new");
    EXPECT_THROW(set.write(name, "new"), Error) << name;
  }
  EXPECT_EQ(contents(scratch / "."), before);
  EXPECT_TRUE(fs::is_symlink(scratch / "dangling") && fs::is_symlink(scratch / "link"));
}

TEST(FileSet, ChangesNothingWithoutACommit) {
  const ScratchFolder scratch;
  write_file_atomically(scratch / "a", "old");
  {
    FileSet set{scratch / "."};
    set.write("a", "new");
    set.write("b", "new");
  }
  {
    FileSet set{scratch / "new/"};
    set.write("a", "new");
  }
  EXPECT_EQ(contents(scratch / "."), (std::map<std::string, std::string>{{"a", "old"}}));
  EXPECT_FALSE(fs::exists(scratch / "new"));
  EXPECT_THROW(FileSet{scratch / "a"}, Error) << "a file";
  fs::create_symlink("nowhere/at/all", scratch / "dangling");
  EXPECT_THROW(FileSet{scratch / "dangling"}, Error);
  EXPECT_TRUE(fs::is_symlink(scratch / "dangling"));
  EXPECT_THROW(FileSet{scratch / "a/b"}, Error);
  const FileSet first{scratch / "."};
  EXPECT_THROW(FileSet{scratch / "."}, Error) << "somebody is at it";
}

}  // namespace
}  // namespace kith
