#include "vocabulary.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "kith/files/atomic_file.hpp"

namespace kith::fuzzing {
namespace {

// The word in a line of a dictionary, whose escapes are \\, \" and \xHH.
std::string word_of(std::string_view line) {
  std::string word;
  for (std::size_t at = 1; at + 1 < line.size(); ++at) {
    if (line[at] != '\\') {
      word += line[at];
    } else if (line[at + 1] == 'x' && at + 3 < line.size()) {
      word += static_cast<char>(std::stoi(std::string{line.substr(at + 2, 2)}, nullptr, 16));
      at += 3;
    } else {
      word += line[++at];
    }
  }
  return word;
}

bool is_name(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  });
}

}  // namespace

Vocabulary::Vocabulary(const std::string& name) {
  const std::filesystem::path folder{KITH_SOURCE_DIR "/tests/fuzz/dictionaries"};
  const auto text = read_file(folder / (name + ".dict"));
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.size(), text.find('\n', at));
    const auto line = std::string_view{text}.substr(at, end - at);
    if (line.size() > 2 && line.front() == '"' && line.back() == '"') words_.push_back(word_of(line));
    at = end + 1;
  }
  std::copy_if(words_.begin(), words_.end(), std::back_inserter(names_), is_name);
}

}  // namespace kith::fuzzing
