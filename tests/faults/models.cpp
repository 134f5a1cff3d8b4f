#include "models.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "process.hpp"
#include "scenario.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kPage = 4096;
constexpr std::size_t kStep = 509;
constexpr std::size_t kMostForms = 4;  // of a damaged journal

[[noreturn]] void fail(const Words& arguments, const Ended& ended) {
  std::string text = "kith";
  for (const auto& word : arguments) text += " " + word;
  throw Error{ErrorKind::kIo,
              "without any fault, `" + text + "` exits with " + std::to_string(ended.code) + ":\n" + ended.err};
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Environment killed_after(int teams) { return {{"KITH_FAILPOINT", "team:" + std::to_string(teams)}}; }

}  // namespace

Ended run_kith(const Tools& tools, const fs::path& folder, const Words& arguments, const Environment& environment) {
  return run({with({tools.program.string()}, arguments), environment, folder});
}

Json comparable_manifest(const std::string& text) {
  auto document = Json::parse(text, nullptr, false);
  if (!document.is_object()) return {};
  for (const auto* key : {"checksum", "started", "stopped", "command_line", "threads", "ranks", "version", "git",
                          "dirty", "compiler", "build_type", "flags", "processor", "system"}) {
    document.erase(key);
  }
  return document;
}

Json comparable_report(const std::string& text) {
  auto document = Json::parse(text, nullptr, false);
  if (!document.is_object()) return {};
  document.erase("created");
  document.erase("notes");
  if (document.contains("tables") && document["tables"].is_object()) document["tables"].erase("timings");
  return document;
}

std::string without_dates(std::string text) {
  constexpr std::string_view kForm = "0000-00-00T00:00:00Z";
  const auto matches = [&](std::size_t at) {
    for (std::size_t i = 0; i < kForm.size(); ++i) {
      const char c = text[at + i];
      if (kForm[i] == '0' ? std::isdigit(static_cast<unsigned char>(c)) == 0 : c != kForm[i]) return false;
    }
    return true;
  };
  for (auto at = text.find('T'); at != std::string::npos; at = text.find('T', at + 1)) {
    if (at >= 10 && at - 10 + kForm.size() <= text.size() && matches(at - 10)) {
      text.replace(at - 10, kForm.size(), kForm);
    }
  }
  return text;
}

int teams_taken_up(const std::string& messages) {
  const auto at = messages.find(" teams were already finished");
  const auto of = messages.rfind(" of ", at);
  if (at == std::string::npos || of == std::string::npos) return 0;
  auto begin = of;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(messages[begin - 1])) != 0) --begin;
  return std::atoi(messages.substr(begin, of - begin).c_str());
}

Models::Models(Tools tools, fs::path scratch) : tools_{std::move(tools)}, scratch_{std::move(scratch)} {
  fs::create_directories(scratch_ / "models");
  make_study();
  make_other("seed", {"--seed", "2"});
  make_other("order", {"--set", "design.strategies=[\"common\",\"baseline\"]"});
  make_other("key", {"--set", "teacher.process_noise=0.9"});
  make("replaced", "run", {study_into("run", {"--seed", "2"}), study_into("run", {"--yes"})});
  for (const auto& name : names()) {
    if (fs::exists(folder(name) / "tables")) expect(name);
  }
  for (const std::string name : {"finished", "untabled", "merged", "s1", "s2", "s3"}) {
    add_records(folder(name) / "study.sqlite", records_["run"]);
    if (name.size() == 2) add_records(folder(name) / "study.sqlite", records_[name]);
  }
  for (const std::string name : {"finished", "untabled", "s1"}) damage_journal(name);
  check_messages();
}

void Models::make_study() {
  make("finished", "run", {study_into("run")});
  for (const int teams : {1, 3, 6}) {
    make("unfinished-" + std::to_string(teams), "run", {study_into("run", {"-j", "1"})}, killed_after(teams));
  }
  copy_folder(folder("finished"), folder("untabled"));
  fs::remove_all(folder("untabled") / "tables");
  fs::remove(folder("untabled") / "manifest.json");
  for (const std::string shard : {"1", "2", "3"}) {
    make("s" + shard, "s" + shard, {study_into("s" + shard, {"--shard", shard + "/3"})});
  }
  make("s1-unfinished", "s1", {study_into("s1", {"--shard", "1/3", "-j", "1"})}, killed_after(2));
  make("half-2", "s2", {study_into("s2", {"--shard", "2/2"})});
  make("merged", "run",
       {study_into("s1", {"--shard", "1/3"}),
        study_into("s2", {"--shard", "2/3"}),
        study_into("s3", {"--shard", "3/3"}),
        {"merge", "s1", "s2", "s3", "-o", "run"}});
}

void Models::make_other(const std::string& name, const Words& options) {
  make(name + ".finished", "run", {study_into("run", options)});
  make(name + ".unfinished", "run", {study_into("run", with(options, {"-j", "1"}))}, killed_after(3));
  for (const std::string shard : {"1", "2", "3"}) {
    make(name + ".s" + shard, "s" + shard, {study_into("s" + shard, with(options, {"--shard", shard + "/3"}))});
  }
}

void Models::make(const std::string& model, const std::string& name, const std::vector<Words>& commands,
                  const Environment& environment) {
  const auto place = scratch_ / "make" / "root";
  fs::create_directories(place);
  for (const auto& command : commands) {
    const auto ended = run_kith(tools_, place, command, environment);
    if (ended.code != (environment.empty() ? 0 : kKilled)) fail(command, ended);
  }
  fs::rename(place / name, folder(model));
  fs::remove_all(scratch_ / "make");
}

std::vector<std::string> Models::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator{scratch_ / "models"}) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

const Expected* Models::expected_of(const std::string& model) const {
  const auto found = expected_.find(model);
  return found == expected_.end() ? nullptr : &found->second;
}

void Models::expect(const std::string& model) {
  const auto place = scratch_ / "make" / "root";
  fs::create_directories(place);
  copy_folder(folder(model), place / "run");
  const auto read = [&](const Words& words) {
    auto ended = run_kith(tools_, place, words);
    if (ended.code != 0) fail(words, ended);
    return ended.out;
  };
  Expected expected;
  expected.tables = files_below(place / "run" / "tables");
  expected.inputs = files_below(place / "run" / "inputs");
  expected.manifest = comparable_manifest(read_file(place / "run" / "manifest.json"));
  expected.analysis = read({"analyze", "run", "--json"});
  expected.report = comparable_report(read({"report", "run", "--json"}));
  expected.page = without_dates(read({"report", "run", "-o", "-"}));
  (void)read({"verify", "run"});
  expected_[model] = std::move(expected);
  fs::remove_all(scratch_ / "make");
}

// Cuts off the last pages, or turns over the first byte of a page, or one within a record.
void Models::damage_journal(const std::string& model) {
  const auto place = scratch_ / "make";
  const auto text = read_file(folder(model) / "study.sqlite");
  const auto readable = [&](const std::string& journal) {
    fs::create_directories(place / "run");
    write_text(place / "run" / "study.sqlite", journal);
    const auto number = readable_records(place / "run", records_of("run"), place / "copy").size();
    fs::remove_all(place);
    return number;
  };
  const auto all = readable(text);
  auto& found = damaged_[model];
  const auto try_it = [&](std::string journal) {
    const auto left = readable(journal);
    if (left > 0 && left < all) found.push_back(std::move(journal));
  };
  for (auto at = text.size() / kPage * kPage; at > kPage && found.empty(); at -= kPage) {
    try_it(text.substr(0, at - kPage));
  }
  const auto turn_over = [&](std::size_t at) {
    auto journal = text;
    journal[at] = static_cast<char>(~journal[at]);
    try_it(std::move(journal));
  };
  for (std::size_t at = kPage; at < text.size() && found.size() < kMostForms; at += kPage) turn_over(at);
  for (std::size_t at = text.size() - 1; at > kPage && found.size() < 2; at -= std::min(at, kStep)) turn_over(at);
  if (found.empty()) {
    throw Error{ErrorKind::kIo, "no damage leaves some records of " + model + " readable and others not"};
  }
}

// The checks read from messages how much of a journal was taken up.
void Models::check_messages() {
  const auto place = scratch_ / "make" / "root";
  fs::create_directories(place);
  copy_folder(folder("unfinished-3"), place / "run");
  const auto ended = run_kith(tools_, place, study_into("run"));
  if (ended.code != 0 || teams_taken_up(ended.err) != 3) fail(study_into("run"), ended);
  fs::remove_all(scratch_ / "make");
}

}  // namespace kith::faults
