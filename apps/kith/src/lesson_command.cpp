// kith lesson: a lesson in one file, which teaches whoever opens it.
#include <filesystem>
#include <string>

#include "build_facts.hpp"
#include "command.hpp"
#include "embedded.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/service/lesson_log.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/study_file.hpp"
#include "page.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct LessonOptions {
  std::string what;  ///< A study or a domain.
  std::string out;
  std::vector<std::string> set;
};

bool is_study(const std::string& text) { return text.find("kith.study/") != std::string::npos; }

// The text as a string of TOML.
std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += (c == '"' || c == '\\') ? std::string{'\\', c} : std::string{c};
  return quoted + "\"";
}

StudyReading reading_of(const LessonOptions& options) {
  if (is_study(read_named(options.what).text)) return study_of(options.what, options.set);
  std::string text{detail::kLessonStudy};
  const std::string place = "\"DOMAIN\"";
  text.replace(text.find(place), place.size(), quoted_toml(options.what));
  auto reading = parse_study(text, "the study of a lesson", {.overrides = options.set, .override_name = "--set"});
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

void declare(OptionList& list, LessonOptions& options) {
  list.text("what", options.what, "STUDY|DOMAIN", "A study, or a domain to be taught alone").required();
  list.text("-o,--out", options.out, "FILE", "The lesson, one HTML file; '-' is standard output").required();
  list.texts("--set", options.set, "KEY=VALUE", "Change a key of the study, as in 'kith study'");
}

int run(const LessonOptions& options, Console& console) {
  if (detail::kLessonFilePage.empty()) {
    throw Error{ErrorKind::kInfeasible, "this kith was built without the engine of lesson files",
                "build it with './run.sh --lesson', which says what it installs"};
  }
  const WorkNotice notice{console, "preparing the lesson"};
  const auto reading = reading_of(options);
  console.show(reading.diagnostics);
  const auto folder = std::filesystem::path{options.what}.parent_path();
  const auto document = lesson_document(make_session_study(reading, folder), program_name());
  write_page("lesson", page_with(document.dump(-1, ' ', true), detail::kLessonFilePage), options.out, console);
  console.info(
      "the file holds the robot's weights, for whoever looks for them: do not use it where they must stay hidden");
  return 0;
}

}  // namespace

void add_lesson(Commands& commands) {
  commands.add<LessonOptions>("lesson", "Write a lesson that teaches whoever opens it, in one file",
                              {"kith lesson item-delivery -o lesson.html", "kith lesson study.toml -o lesson.html"},
                              declare, run);
}

}  // namespace kith::cli
