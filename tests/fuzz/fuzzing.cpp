#include "fuzzing.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "kith/core/error.hpp"

namespace kith::fuzzing {
namespace {

// Of mistakes that keep a text from being looked at any further: TOML, tables, worlds.
constexpr std::array<std::string_view, 12> kSyntaxIds{"E0101", "E0102", "E0103", "E0104", "E0105", "E0501",
                                                      "E0502", "E0503", "E0504", "E0508", "E0509", "E0512"};

Outcome outcome_of(const std::vector<Diagnostic>& diagnostics) {
  if (!has_errors(diagnostics)) return Outcome::kRead;
  const bool malformed = std::any_of(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& d) {
    return std::find(kSyntaxIds.begin(), kSyntaxIds.end(), d.id) != kSyntaxIds.end();
  });
  return malformed ? Outcome::kMalformed : Outcome::kRefused;
}

std::size_t width_of(std::string_view input) {
  return kForm.width == kByFirstByte ? Bytes{input}.dimension() : kForm.width;
}

HeadAndBody parts_of(std::string_view input) {
  return kForm.head_lines > 0 ? behind_lines(input, kForm.head_lines) : behind_bytes(input, kForm.head_bytes);
}

// Line `number` of the text, without its end; nothing beyond the last.
std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1; --number) text = text.substr(std::min(text.size(), text.find('\n')) + (text.empty() ? 0 : 1));
  text = text.substr(0, text.find('\n'));
  return text.ends_with('\r') ? text.substr(0, text.size() - 1) : text;
}

// The text of a diagnostic is made only where a claim does not hold: there are many, and it takes long.
void require(bool holds, std::string_view claim, const Diagnostic& diagnostic) {
  if (!holds) fuzzing::require(false, claim, to_text(diagnostic));
}

void require_place(const Diagnostic& d, std::string_view text) {
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  require(d.line <= lines, "a diagnostic's line exists", d);
  require((d.line == 0) == (d.column == 0), "a diagnostic has line and column, or neither", d);
  const auto line = d.line > 0 ? line_of(text, d.line) : std::string_view{};
  require(d.column <= line.size() + 1, "a diagnostic's column is in its line or right behind it", d);
}

}  // namespace

HeadAndBody behind_bytes(std::string_view input, std::size_t bytes) {
  return {input.substr(0, bytes), input.substr(std::min(bytes, input.size()))};
}

HeadAndBody behind_lines(std::string_view input, std::size_t lines) {
  std::size_t at = 0;
  for (; lines > 0 && at < input.size(); --lines) at = std::min(input.size(), input.find('\n', at)) + 1;
  return behind_bytes(input, at);
}

std::string mutated(std::string_view input, Dice& dice) {
  if (kForm.words == nullptr) return mutate_vectors(input, kForm.head_bytes, width_of(input), dice);
  static const Vocabulary kVocabulary{kForm.words};
  if (input.empty() || dice.one_in(kForm.bytes_one_in)) return mutate_bytes(input, dice);
  const auto [head, body] = parts_of(input);
  if (kForm.head_lines > 0 && dice.one_in(4)) return mutate_text(head, kVocabulary, dice) + std::string{body};
  return std::string{head} + mutate_text(body, kVocabulary, dice);
}

std::string crossed(std::string_view input, std::string_view other, Dice& dice) {
  const auto [head, body] = parts_of(input);
  const auto [other_head, other_body] = parts_of(other);
  if (kForm.words != nullptr) {
    if (kForm.head_lines > 0 && dice.one_in(4)) return std::string{other_head} + std::string{body};
    return std::string{head} + cross_text(body, other_body, dice);
  }
  const auto row = std::max<std::size_t>(1, width_of(input));
  const auto cut = [&](std::string_view rows) { return row * dice.below(rows.size() / row + 1); };
  const auto first = body.substr(0, cut(body));
  return std::string{head}.append(first).append(other_body.substr(cut(other_body)));
}

void require(bool holds, std::string_view claim, std::string_view detail) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n%s\n", std::string{claim}.c_str(), std::string{detail}.c_str());
  std::abort();
}

Outcome require_good(const std::vector<Diagnostic>& diagnostics, std::string_view text, const std::string& file) {
  for (const auto& d : diagnostics) {
    require(d.id.size() == 5 && (d.id.front() == 'E' || d.id.front() == 'W'), "a diagnostic has an id", d);
    require(!d.message.empty() && d.length >= 1, "a diagnostic says something", d);
    require(!d.file.empty(), "a diagnostic names its file", d);
    if (d.file == file) require_place(d, text);
  }
  return outcome_of(diagnostics);
}

Outcome reads(std::string_view text, const std::string& file, const std::function<void()>& read) {
  try {
    read();
    return Outcome::kRead;
  } catch (const Error& error) {
    require(*error.what() != '\0', "an error says something");
    require(error.diagnostics().empty() || has_errors(error.diagnostics()), "what stops is an error", error.what());
    const auto& all = error.diagnostics();
    const bool is_advice = all.size() == 1 && all.front().file.empty() && all.front().message == error.what();
    return all.empty() || is_advice ? Outcome::kRefused : require_good(all, text, file);
  }
}

std::uint8_t Bytes::byte() {
  if (left_.empty()) return 0;
  const auto byte = static_cast<std::uint8_t>(left_.front());
  left_.remove_prefix(1);
  return byte;
}

std::int64_t Bytes::integer(std::int64_t limit) {
  const std::int64_t high = byte();
  return (high * 256 + byte()) % (2 * limit + 1) - limit;
}

std::string_view Bytes::line() {
  const auto line = left_.substr(0, left_.find('\n'));
  left_.remove_prefix(std::min(left_.size(), line.size() + 1));
  return line;
}

MemoryFile::MemoryFile(std::string_view content) : descriptor_{memfd_create("fuzz", 0)} {
  require(descriptor_ >= 0, "there is room for a file in memory");
  for (std::size_t done = 0; done < content.size();) {
    const auto written = write(descriptor_, content.data() + done, content.size() - done);
    require(written > 0, "a file in memory takes its content");
    done += static_cast<std::size_t>(written);
  }
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::filesystem::path MemoryFile::path() const {
  return std::filesystem::path{"/proc/self/fd"} / std::to_string(descriptor_);
}

}  // namespace kith::fuzzing
