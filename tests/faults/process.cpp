#include "process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"

namespace kith::faults {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::minutes kPatience{1};

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environment_of(const Command& command) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (std::string_view{*entry}.rfind("KITH_", 0) != 0) all.emplace_back(*entry);
  }
  for (const auto& [name, value] : command.environment) all.push_back(name + "=" + value);
  return all;
}

class FileActions {
 public:
  explicit FileActions(const Command& command) {
    posix_spawn_file_actions_init(&actions_);
    const auto beside = command.folder.parent_path();
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, (beside / "out").c_str(), kFlags, 0600);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, (beside / "err").c_str(), kFlags, 0600);
    posix_spawn_file_actions_addchdir_np(&actions_, command.folder.c_str());
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

// Waits until the process has ended, though not beyond `end`; returns whether it has.
bool wait_until(int process, Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    const timespec time{left / 1'000'000'000, left % 1'000'000'000};
    pollfd waiting{process, POLLIN, 0};
    const int ready = ppoll(&waiting, 1, &time, nullptr);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;
  }
}

}  // namespace

Ended run(const Command& command) {
  auto words = command.words;
  auto environment = environment_of(command);
  const FileActions actions{command};
  pid_t child = 0;
  const int failed = posix_spawn(&child, words.front().c_str(), actions.get(), nullptr, pointers_to(words).data(),
                                 pointers_to(environment).data());
  if (failed != 0) {
    throw Error{ErrorKind::kIo, "cannot start " + words.front() + ": " + std::generic_category().message(failed)};
  }
  const auto begin = Clock::now();
  const int process = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  Ended ended;
  if (command.kill_after && !wait_until(process, begin + *command.kill_after)) {
    kill(child, SIGKILL);
  } else if (!wait_until(process, begin + kPatience)) {
    ended.hung = true;
    kill(child, SIGKILL);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (process >= 0) close(process);
  ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ended.out = read_file(command.folder.parent_path() / "out");
  ended.err = read_file(command.folder.parent_path() / "err");
  return ended;
}

}  // namespace kith::faults
