// kith lesson: what is taught, for a terminal or as a page; with an engine in the page it adapts to whoever opens it.
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "build_facts.hpp"
#include "command.hpp"
#include "curriculum_command.hpp"
#include "embedded.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/occupancy_grid.hpp"
#include "kith/service/lesson_log.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/study_file.hpp"
#include "learning_package.hpp"
#include "page.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct LessonOptions {
  std::string what;     ///< A study or a domain.
  std::string knowing;  ///< The robot before an update, which everybody knows; empty: as the study says.
  std::string out;      ///< Empty: the lesson is printed.
  std::uint64_t seed = 1;
  bool is_adaptive = false;
  std::vector<std::string> set;
  std::vector<std::string> origins;
  bool is_playground = false;
  bool has_exam = false;
};

// What cannot be read is no study; whoever reads it as a domain says what is wrong.
bool is_study(const std::string& what) try {
  return read_named(what).text.find("kith.study/") != std::string::npos;
} catch (const Error&) {
  return false;
}

// The text as a string of TOML.
std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += (c == '"' || c == '\\') ? std::string{'\\', c} : std::string{c};
  return quoted + "\"";
}

StudyReading reading_of(LessonOptions options) {
  if (options.has_exam) options.set.emplace_back("group.exam=true");
  if (is_study(options.what)) return study_of(options.what, options.set);
  std::string text{detail::kLessonStudy};
  const std::string place = "\"DOMAIN\"";
  text.replace(text.find(place), place.size(), quoted_toml(options.what));
  auto reading = parse_study(text, "the study of a lesson", {.overrides = options.set, .override_name = "--set"});
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

// The engine of a page reads no YAML: the same table as JSON.
void write_as_json(DomainFile& file) {
  if (!file.name.ends_with(".yaml") && !file.name.ends_with(".yml")) return;
  detail::ModelReport report;  // has been said
  const auto table = detail::read_yaml_table({file.name, file.name, file.text}, report);
  nlohmann::json json;
  for (const auto& [key, value] : table.value())
    json[key] = value.is_list ? nlohmann::json(value.scalars) : nlohmann::json(value.scalars.at(0));
  file.text = json.dump();
}

// The same for people who know the robot as it was before an update.
StudyReading reading_for(LessonOptions options) {
  auto reading = reading_of(options);
  if (options.knowing.empty()) return reading;
  for (const auto& type : reading.study->variants.front().learner_types) {
    if (type.mixture.empty())
      options.set.push_back(fmt::format("learner.{}.knowing={}", type.letter, quoted_toml(options.knowing)));
  }
  return reading_of(options);
}

// A scheme and a host, and perhaps a port: what a browser calls an origin.
void require_origin(const std::string& text) {
  const auto scheme = text.find("://");
  const bool has_scheme = scheme != std::string::npos && (text.starts_with("https://") || text.starts_with("http://"));
  const auto rest = has_scheme ? text.substr(scheme + 3) : std::string{};
  if (!rest.empty() && rest.find_first_of("/?#@* ") == std::string::npos) return;
  refuse("--origin " + text + " is no origin", "give scheme and host alone, such as https://survey.example.org");
}

// The lesson with what SCORM 1.2 and cmi5 want to know of it. Only the page of a package may ask its learning system.
void write_package(Json document, const std::string& out, Console& console) {
  document["package"] = true;
  std::string_view template_page{detail::kLessonFilePage};
  std::string page{template_page};
  const std::string closed = "connect-src 'none'";
  page.replace(page.find(closed), closed.size(), "connect-src 'self' https: http:");
  page = page_with(document.dump(-1, ' ', true), page);
  const auto title = document.at("title").get<std::string>();
  const auto digest = document.at("digest").get<std::string>();
  const auto zip = stored_zip({{"imsmanifest.xml", scorm_manifest(title, digest)},
                               {"cmi5.xml", cmi5_course(title, digest)},
                               {"lesson.html", page}});
  write_file_atomically(out, zip, FolderSync::kNow, OldLink::kFollow);
  console.info(
      fmt::format("a package with the lesson in {} ({:.0f} kB); upload it to a learning system as SCORM 1.2 or cmi5",
                  out, static_cast<double>(zip.size()) / 1e3));
}

void declare(OptionList& list, LessonOptions& options) {
  list.text("what", options.what, "STUDY|DOMAIN", "A study, or a domain to be taught alone").required();
  list.text("-o,--out", options.out, "FILE",
            "Write the lesson, one HTML file ('-' is standard output), or a .zip for learning systems");
  list.text("--knowing", options.knowing, "DOMAIN", "The robot before an update, which people know");
  list.flag("--adaptive", options.is_adaptive,
            "A page that chooses each lesson by the answers so far, as that of a study and a .zip always do");
  list.integer("--seed", options.seed, {}, "Seed of all random streams of a lesson that does not adapt");
  list.json();
  list.flag("--playground", options.is_playground, "Sliders and a board to paint instead of the lesson alone");
  list.flag("--exam", options.has_exam, "An exam at the end, like group.exam of a study; the page is then adaptive");
  list.texts("--origin", options.origins, "URL",
             "Tell the page around the lesson how it goes, if that page is from this origin");
  list.texts("--set", options.set, "KEY=VALUE", "Change a key of the study, as in 'kith study'");
}

int run(const LessonOptions& options, Console& console) {
  const bool is_package = std::filesystem::path{options.out}.extension() == ".zip";
  const bool adapts = options.is_adaptive || options.has_exam || options.is_playground || is_package ||
                      !options.origins.empty() || !options.set.empty() || is_study(options.what);
  if (!adapts) return show_curriculum({options.what, options.knowing, options.out, options.seed}, console);
  if (options.out.empty() || console.json())
    refuse("a lesson that adapts is a page", "write it with -o lesson.html or -o lesson.zip, without --json");
  require_engine();
  const WorkNotice notice{console, "preparing the lesson"};
  auto reading = reading_for(options);
  console.show(reading.diagnostics);
  for (auto& file : reading.domain_files) write_as_json(file);
  const auto folder = std::filesystem::path{options.what}.parent_path();
  auto document = lesson_document(make_session_study(reading, folder), program_name());
  for (const auto& origin : options.origins) require_origin(origin);
  document["origins"] = options.origins;
  if (!is_study(options.what) && options.set.empty()) document["alone"] = true;
  if (options.is_playground) {
    if (is_package) refuse("--playground makes a page, not a package for learning systems", "name a file.html with -o");
    document["playground"] = true;
  }
  if (is_package) {
    write_package(document, options.out, console);
  } else {
    write_page("lesson", page_with(document.dump(-1, ' ', true), detail::kLessonFilePage), options.out, console);
  }
  console.info(
      "the file holds the robot's weights, for whoever looks for them: do not use it where they must stay hidden");
  return 0;
}

}  // namespace

void add_lesson(Commands& commands) {
  commands.add<LessonOptions>("lesson", "Show what would be taught, or write a page that teaches it",
                              {"kith lesson item-delivery", "kith lesson my-domain.toml -o lesson.html",
                               "kith lesson item-delivery --adaptive -o lesson.html",
                               "kith lesson study.toml -o lesson.zip", "kith lesson new.toml --knowing old.toml"},
                              declare, run);
}

}  // namespace kith::cli
