#include "kith/store/session_study.hpp"

#include <stdexcept>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/bytes.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"
#include "kith/files/temporary_folder.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStudyFile = "study.toml";
constexpr const char* kDomainFile = "domain.toml";
constexpr const char* kConsentFile = "consent.txt";
constexpr const char* kLanguageFile = "language.json";

std::string inputs_digest(const std::map<std::string, std::string>& inputs) {
  ByteWriter text;
  for (const auto& [name, content] : inputs) {
    text.text(name);
    text.text(content);
  }
  return sha256(text.bytes());
}

std::shared_ptr<const LiveStudy> live_study(const StudyReading& reading, const fs::path& folder) {
  if (!reading.study || !reading.domain) throw std::invalid_argument{"make_session_study: the reading has no study"};
  const auto atlas = std::make_shared<const Atlas>(*reading.domain);
  return make_live_study(*reading.study, atlas, folder, reading.domain_text);
}

// The study with the group's files under names of our own; their texts are added to the inputs.
Study with_own_files(Study study, const fs::path& folder, std::map<std::string, std::string>& inputs) {
  const auto freeze_file = [&](std::string& name, const char* frozen) {
    if (name.empty()) return;
    inputs.emplace(frozen, read_file(folder / name));
    name = frozen;
  };
  auto group = study.variants.front().group;
  freeze_file(group.consent_file, kConsentFile);
  freeze_file(group.language, kLanguageFile);
  for (auto& variant : study.variants) variant.group = group;
  return study;
}

[[noreturn]] void refuse_inputs(const std::string& why) {
  refuse_run(ErrorKind::kMismatch, "E1617", kStudyFile,
             "the study that is kept with the session cannot be used: " + why,
             "use the version of kith that made the session");
}

// Whether the name stays in the folder that it is put into.
bool is_plain(const std::string& name) {
  const fs::path path{name};
  if (path.empty() || path.is_absolute()) return false;
  for (const auto& part : path) {
    if (part == "..") return false;
  }
  return true;
}

}  // namespace

SessionStudy make_session_study(const StudyReading& reading, const fs::path& folder) {
  SessionStudy session{.study = live_study(reading, folder), .inputs = {}, .digest = {}};
  auto study = with_own_files(reading.study.value(), folder, session.inputs);
  for (auto& variant : study.variants) variant.domain = kDomainFile;
  session.inputs.emplace(kStudyFile, to_toml(study, reading.domain.value(), GroupText::kWritten));
  session.inputs.emplace(kDomainFile, reading.domain_text);
  for (const auto& file : reading.domain_files) session.inputs.emplace(file.name, file.text);
  session.digest = inputs_digest(session.inputs);
  return session;
}

SessionStudy restore_session_study(const std::map<std::string, std::string>& inputs) {
  if (inputs.find(kStudyFile) == inputs.end()) refuse_inputs("there is no study.toml");
  const TemporaryFolder folder{"kith-session"};
  for (const auto& [name, text] : inputs) {
    if (!is_plain(name)) refuse_inputs("the name of '" + name + "' leads out of its folder");
    fs::create_directories((folder.path() / name).parent_path());
    write_file_atomically(folder.path() / name, text);
  }
  const auto reading = load_study((folder.path() / kStudyFile).string());
  if (!reading.study || !reading.domain) {
    for (const auto& diagnostic : reading.diagnostics) {
      if (diagnostic.severity == Severity::kError) refuse_inputs(diagnostic.message);
    }
    refuse_inputs("it has errors");
  }
  return {.study = live_study(reading, folder.path()), .inputs = inputs, .digest = inputs_digest(inputs)};
}

}  // namespace kith
