#include "kith/files/atomic_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <thread>
#include <vector>

#include "kith/core/error.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// A folder of its own for each test, removed afterwards.
class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path{::testing::TempDir()} / ("kith_atomic_" + std::to_string(getpid()) + "_" +
                                                ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::size_t num_entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator{folder_}, fs::directory_iterator{}));
  }

  // Runs the action and returns the message of the kIo error that it must throw.
  template <typename Action>
  static std::string io_error(Action action) {
    try {
      action();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kIo);
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  }

  fs::path folder_;
};

TEST_F(AtomicFileTest, WritesAndReplacesAWholeFile) {
  const auto path = folder_ / "a file \xC3\xA9.csv";
  write_file_atomically(path, "one");
  EXPECT_EQ(read_file(path), "one");
  const std::string large(1'000'000, 'x');
  write_file_atomically(path, large);
  EXPECT_EQ(read_file(path), large);
  write_file_atomically(path, "");
  EXPECT_EQ(read_file(path), "");
  EXPECT_EQ(num_entries(), 1u);
}

TEST_F(AtomicFileTest, ShowsNothingBeforeItIsCommitted) {
  const auto path = folder_ / "t.csv";
  write_file_atomically(path, "old");
  {
    AtomicFile file{path};
    file.write("ne");
    file.write("w");
    EXPECT_EQ(read_file(path), "old");
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(num_entries(), 1u);
  AtomicFile file{path};
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(path), "new");
  EXPECT_EQ(num_entries(), 1u);
}

TEST_F(AtomicFileTest, KeepsPermissionsAndSymbolicLinks) {
  const auto path = folder_ / "real.csv";
  const auto link = folder_ / "link.csv";
  write_file_atomically(path, "old");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  fs::create_symlink("real.csv", link);
  write_file_atomically(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_file(path), "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
}

TEST_F(AtomicFileTest, WritesInTheWorkingFolderByABareName) {
  const auto before = fs::current_path();
  fs::current_path(folder_);
  write_file_atomically("bare.csv", "x");
  fs::current_path(before);
  EXPECT_EQ(read_file(folder_ / "bare.csv"), "x");
}

TEST_F(AtomicFileTest, SaysWhenTheDiskIsFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string message = io_error([] { write_file_atomically("/dev/full", "x"); });
  EXPECT_THAT(message, HasSubstr("/dev/full"));
  EXPECT_THAT(message, HasSubstr("No space left on device"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));  // and not replaced by a file
}

TEST_F(AtomicFileTest, SaysWhenThereIsNoFolderOrItIsAFile) {
  write_file_atomically(folder_ / "file", "x");
  const auto below = folder_ / "file" / "t.csv";  // permissions do not hold back root; this does
  const std::string message = io_error([&] { write_file_atomically(below, "x"); });
  EXPECT_THAT(message, HasSubstr(below.string()));
  EXPECT_THAT(message, HasSubstr("Not a directory"));
  EXPECT_THAT(io_error([&] { write_file_atomically(folder_ / "none" / "t.csv", "x"); }),
              HasSubstr("No such file or directory"));
  EXPECT_THAT(io_error([&] { write_file_atomically(folder_, "x"); }), HasSubstr("Is a directory"));
  EXPECT_THAT(io_error([&] { (void)read_file(folder_ / "none"); }), HasSubstr("No such file or directory"));
  EXPECT_THAT(io_error([&] { (void)read_file(folder_); }), HasSubstr("Is a directory"));
  EXPECT_EQ(num_entries(), 1u);
}

TEST_F(AtomicFileTest, LeavesNothingBehindWhenItCannotBePutInPlace) {
  const auto path = folder_ / "t.csv";
  AtomicFile file{path};
  file.write("x");
  fs::create_directory(path);
  fs::create_directory(path / "full");
  EXPECT_THAT(io_error([&] { file.commit(); }), HasSubstr(path.string()));
  fs::remove_all(path);
}

// Whether files without a name can be made where the tests are.
bool has_unnamed_files(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0600);
  if (descriptor >= 0) close(descriptor);
  return descriptor >= 0;
}

TEST_F(AtomicFileTest, LeavesNothingBehindWhenTheProcessIsKilled) {
  if (!has_unnamed_files(folder_)) GTEST_SKIP() << "this file system has no files without a name";
  write_file_atomically(folder_ / "old.csv", "old");
  for (const auto* name : {"old.csv", "new.csv"}) {
    const pid_t child = fork();
    if (child == 0) {
      AtomicFile file{folder_ / name};
      file.write("half");
      _exit(0);  // no destructor is called, as with kill -9
    }
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_EQ(num_entries(), 1u) << name;
  }
  EXPECT_EQ(read_file(folder_ / "old.csv"), "old");
}

TEST_F(AtomicFileTest, ReplacesALinkInsteadOfItsTargetWhenAskedTo) {
  write_file_atomically(folder_ / "precious", "old");
  fs::create_symlink("precious", folder_ / "link");
  fs::create_symlink("nowhere", folder_ / "dangling");
  for (const auto* name : {"link", "dangling"}) {
    write_file_atomically(folder_ / name, "new", FolderSync::kNow, OldLink::kReplace);
    EXPECT_FALSE(fs::is_symlink(folder_ / name)) << name;
    EXPECT_EQ(read_file(folder_ / name), "new");
  }
  EXPECT_EQ(read_file(folder_ / "precious"), "old");
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
}

TEST_F(AtomicFileTest, DoesNotWaitForAReaderOfANamedPipe) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  alarm(60);  // a guard: opening would wait for ever
  EXPECT_THAT(io_error([&] { write_file_atomically(pipe, "x"); }), HasSubstr("no program reads from this pipe"));
  alarm(0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  write_file_atomically(pipe, "x");
  char byte = 0;
  EXPECT_EQ(read(reader, &byte, 1), 1);
  EXPECT_EQ(byte, 'x');
  close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(AtomicFileTest, WritesThroughTheNameOfAnOpenPipe) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(pipe(ends), 0);
  write_file_atomically("/dev/fd/" + std::to_string(ends[1]), "x");  // as `-o >(...)` in a shell
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 1);
  EXPECT_EQ(byte, 'x');
  close(ends[0]);
  close(ends[1]);
}

TEST_F(AtomicFileTest, IsReadFromARegularFileOnly) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  alarm(60);  // a guard: opening would wait for ever
  EXPECT_THAT(io_error([&] { (void)read_file(pipe); }), HasSubstr("it is not a regular file"));
  EXPECT_THAT(io_error([] { (void)read_file("/dev/zero"); }), HasSubstr("it is not a regular file"));
  alarm(0);
}

// Readers at any moment see one of the whole contents.
TEST_F(AtomicFileTest, IsNeverSeenHalfWritten) {
  const auto path = folder_ / "t.csv";
  const std::string a(20'000, 'a');
  const std::string b(30'000, 'b');
  write_file_atomically(path, a);
  std::vector<std::thread> writers;
  for (const std::string* content : {&a, &b}) {
    writers.emplace_back([&path, content] {
      for (int i = 0; i < 20; ++i) write_file_atomically(path, *content);
    });
  }
  for (int i = 0; i < 200; ++i) {
    const std::string seen = read_file(path);
    ASSERT_TRUE(seen == a || seen == b);
  }
  for (auto& writer : writers) writer.join();
  EXPECT_EQ(num_entries(), 1u);
}

}  // namespace
}  // namespace kith
