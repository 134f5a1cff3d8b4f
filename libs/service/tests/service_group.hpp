#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kith/store/session_export.hpp"
#include "service_support.hpp"

namespace kith::testing {

inline constexpr const char* kQuestions =
    "questions = [{ id = \"clear\", kind = \"likert\", text = \"Was it clear?\", required = true },\n"
    "             { id = \"say\", kind = \"text\", text = \"Anything else?\" }]\n"
    "collect_query = [\"PROLIFIC_PID\"]\n";

/// The page of whoever has that link, up to date.
[[nodiscard]] inline std::unique_ptr<Page> open_page_of(Stage& stage, const std::string& token) {
  auto page = std::make_unique<Page>(token, "tab of " + token);
  page->connect(stage.service());
  stage.service().settle();
  page->read();
  return page;
}

/// Three people in one room of the study, connected.
[[nodiscard]] inline std::vector<std::unique_ptr<Page>> three_people(Stage& stage) {
  const auto code = stage.join_code();
  std::vector<std::unique_ptr<Page>> people;
  for (const auto* name : {"a", "b", "c"}) {
    const auto token = stage.join(code, {{"PROLIFIC_PID", std::string{"pid-"} + name}, {"other", "x"}});
    EXPECT_FALSE(token.empty());
    people.push_back(std::make_unique<Page>(token, name));
    people.back()->connect(stage.service());
  }
  stage.service().settle();
  for (auto& person : people) person->read();
  return people;
}

/// A server and the people at it.
struct Hosted {
  explicit Hosted(SessionStudy study) : stage{scratch / "live", std::move(study)} {}
  /// Everything happens that is under way, and everybody sees it.
  void settle() {
    stage.service().settle();
    for (auto& person : people) person->read();
  }
  /// Does what the page of somebody asks for next. @return the id of the message
  std::string act(Page& person, bool is_right = true) {
    const auto step = next_step(person.view(), solver, is_right);
    const auto id = person.ask(stage.service(), step->first, step->second);
    settle();
    return id;
  }
  /// Time goes by while the pages of those who are connected are open.
  void pass(int seconds) {
    for (; seconds > 0; --seconds) {
      for (auto& person : people) person->beat(stage.service());
      stage.pass_ms(1000);
    }
    settle();
  }
  /// The server ends and starts again, and everybody reconnects.
  void restart() {
    stage.restart();
    for (auto& person : people) {
      person->lose();
      person->connect(stage.service());
    }
    settle();
  }

  ScratchFolder scratch;
  Stage stage;
  Solver solver{stage.study().study};
  std::vector<std::unique_ptr<Page>> people;
};

/// A server with three people in its first room.
struct Group : Hosted {
  explicit Group(const std::string& section = "") : Hosted{small_study(section)} { people = three_people(stage); }
};

/// Until everybody is at a stage.
[[nodiscard]] inline bool play_until(Stage& stage, std::vector<std::unique_ptr<Page>>& people, Solver& solver,
                                     const std::string& wanted) {
  for (int round = 0; round < 300; ++round) {
    bool is_there = true;
    for (auto& person : people) {
      person->read();
      if (person->stage() == wanted) continue;
      is_there = false;
      const auto step = next_step(person->view(), solver, true);
      if (step && person->unsaved().empty()) person->ask(stage.service(), step->first, step->second);
    }
    if (is_there) return true;
    stage.service().settle();
    if (round % 4 == 3) stage.pass_ms(100);
  }
  return false;
}

/// Whether the text is in any file of the session. @pre the server has stopped.
[[nodiscard]] inline bool is_stored(const Stage& stage, const std::string& text) {
  const std::filesystem::directory_iterator files{stage.folder()};
  return std::any_of(begin(files), end(files), [&](const std::filesystem::directory_entry& file) {
    return read_file(file.path()).find(text) != std::string::npos;
  });
}

[[nodiscard]] inline EventFile stored(const Stage& stage) { return EventFile::read(stage.folder()); }

[[nodiscard]] inline std::map<std::string, std::string> exported(const Stage& stage,
                                                                 const SessionExportOptions& options = {}) {
  auto file = stored(stage);
  TeachingCache cache{stage.study().study->atlas};
  std::map<std::string, std::string> files;
  export_session(file, stage.study().study, cache, options,
                 [&](std::string_view name, std::string_view piece) { files[std::string{name}] += piece; });
  return files;
}

}  // namespace kith::testing
