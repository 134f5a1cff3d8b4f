// Gives a target every file of its corpus and some mutations of each, always the same, so that what fuzzing once found
// stays mended where libFuzzer is not:
//
//   fuzz_replay_<target> FOLDER...
//
// Fails, by ending, where the target does, and if there is no file at all.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

#include "fuzzing.hpp"
#include "kith/files/atomic_file.hpp"

namespace {

void run_mutations(const std::string& input, const std::string& other) {
  constexpr std::uint64_t kMutations = 6;
  constexpr std::size_t kLongest = 4096;
  for (std::uint64_t seed = 1; seed <= kMutations; ++seed) {
    const auto mutation = [&] {
      kith::fuzzing::Dice dice{seed};
      return seed == 1 ? kith::fuzzing::crossed(input, other, dice) : kith::fuzzing::mutated(input, dice);
    };
    const auto mutated = mutation();
    kith::fuzzing::require(mutated == mutation(), "a mutation follows from the input and the seed");
    if (mutated.size() <= kLongest) (void)kith::fuzzing::run(mutated);
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator{arguments[i]}) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::string before;
  for (const auto& file : files) {
    std::fprintf(stderr, "%s\n", file.c_str());  // the last one is the culprit
    try {
      auto content = kith::read_file(file);
      (void)kith::fuzzing::run(content);
      run_mutations(content, before);
      before = std::move(content);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "throws: %s\n", error.what());
      return 1;
    }
  }
  std::fprintf(stderr, "%zu inputs\n", files.size());
  return files.empty() ? 1 : 0;
}
