#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scratch_folder.hpp"

namespace kith::testing {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

/// What a run of the program came to.
struct Ran {
  int code = -1;  ///< Exit code; 128 + signal if one ended it.
  std::string out, err;
};

/// How to run it.
struct RunWith {
  std::vector<std::pair<std::string, std::string>> environment{};
  std::string input{};
  std::string out_to{};             ///< A file for standard output, such as "/dev/full".
  std::function<void()> prepare{};  ///< Called in the new process just before it becomes the program.
};

[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

using Tables = std::map<std::string, std::string>;

/// The tables of a run by their names; none where there is no such run.
[[nodiscard]] inline Tables tables_in(const std::filesystem::path& run) {
  Tables tables;
  if (!std::filesystem::exists(run / "tables")) return tables;
  for (const auto& entry : std::filesystem::directory_iterator{run / "tables"}) {
    tables[entry.path().filename().string()] = text_of(entry.path());
  }
  return tables;
}

/// A folder of its own, removed at the end; names in it are strings, as arguments are.
class Scratch {
 public:
  [[nodiscard]] std::string operator/(std::string_view name) const { return (folder_ / name).string(); }

 private:
  ScratchFolder folder_;
};

/// Starts the program without a shell; the caller waits for the process.
[[nodiscard]] inline pid_t start_kith(const std::vector<std::string>& arguments, const RunWith& with,
                                      const std::string& in, const std::string& out, const std::string& err) {
  const pid_t child = fork();
  if (child != 0) return child;
  const auto redirect = [](const std::string& file, int flags, int descriptor) {
    const int opened = open(file.c_str(), flags, 0600);
    if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
  };
  redirect(in, O_RDONLY, STDIN_FILENO);
  redirect(out, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  redirect(err, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  for (const auto& [name, value] : with.environment) setenv(name.c_str(), value.c_str(), 1);
  if (with.prepare) with.prepare();
  std::vector<std::string> words{KITH_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(KITH_PROGRAM, argv.data());
  _exit(127);
}

[[nodiscard]] inline int exit_code_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Runs the program and returns all that it said.
[[nodiscard]] inline Ran run_kith(const std::vector<std::string>& arguments, const RunWith& with = {}) {
  const Scratch scratch;
  std::ofstream{scratch / "in"} << with.input;
  const auto out = with.out_to.empty() ? scratch / "out" : with.out_to;
  Ran ran;
  ran.code = exit_code_of(start_kith(arguments, with, scratch / "in", out, scratch / "err"));
  if (with.out_to.empty()) ran.out = text_of(out);
  ran.err = text_of(scratch / "err");
  return ran;
}
inline void expect_code(int code, const std::vector<std::string>& arguments, const RunWith& with = {}) {
  const auto ran = run_kith(arguments, with);
  EXPECT_EQ(ran.code, code) << ran.err;
}
/// What a run prints that is to succeed.
[[nodiscard]] inline std::string out_of(const std::vector<std::string>& arguments, const RunWith& with = {}) {
  const auto ran = run_kith(arguments, with);
  EXPECT_EQ(ran.code, 0) << ran.err;
  return ran.out;
}
[[nodiscard]] inline Json json_of(std::vector<std::string> arguments, int code = 0) {
  arguments.emplace_back("--json");
  const auto ran = run_kith(arguments);
  EXPECT_EQ(ran.code, code) << ran.err;
  return Json::parse(ran.out);
}
/// What a run says that is to fail with this code.
[[nodiscard]] inline std::string err_of(int code, const std::vector<std::string>& arguments, const RunWith& with = {}) {
  const auto ran = run_kith(arguments, with);
  EXPECT_EQ(ran.code, code) << ran.out << ran.err;
  return ran.err;
}

}  // namespace kith::testing
