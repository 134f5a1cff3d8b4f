#include "damage.hpp"

#include <algorithm>
#include <cstdlib>

#include "draw.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_fault(const std::string& fault) {
  throw Error{ErrorKind::kUsage, "'" + fault + "' is no damage that can be done here"};
}

// The files of a folder whose names begin so.
std::vector<fs::path> files_with_prefix(const fs::path& prefix) {
  std::vector<fs::path> files;
  if (!fs::is_directory(prefix.parent_path())) return files;
  for (const auto& entry : fs::directory_iterator{prefix.parent_path()}) {
    if (entry.path().filename().string().rfind(prefix.filename().string(), 0) == 0) files.push_back(entry.path());
  }
  return files;
}

bool flip(const fs::path& file, const std::string& at) {
  auto text = read_file(file);
  const auto bit = std::strtoull(at.c_str(), nullptr, 10);
  if (bit / 8 >= text.size()) refuse_fault(file.string() + ":" + at);
  text[bit / 8] = static_cast<char>(text[bit / 8] ^ static_cast<char>(1u << bit % 8));
  write_text(file, text);
  return true;
}

bool truncate(const fs::path& file, const std::string& length) {
  if (!fs::exists(file)) refuse_fault(file.string());
  if (length == "gone") return fs::remove(file);
  const auto before = fs::file_size(file);
  fs::resize_file(file, std::min<std::uintmax_t>(std::strtoull(length.c_str(), nullptr, 10), before));
  return fs::file_size(file) != before;
}

bool mix(const fs::path& to, const fs::path& from) {
  if (to.filename().string().back() == '*') {
    const auto prefix = [](const fs::path& path) {
      auto text = path.string();
      text.pop_back();
      return fs::path{text};
    };
    for (const auto& file : files_with_prefix(prefix(to))) fs::remove(file);
    for (const auto& file : files_with_prefix(prefix(from))) fs::copy_file(file, to.parent_path() / file.filename());
    return true;
  }
  if (!fs::exists(from)) refuse_fault(from.string());
  fs::create_directories(to.parent_path());
  if (fs::is_directory(from)) {
    const bool same = files_below(from) == files_below(to);
    fs::remove_all(to);
    copy_folder(from, to);
    return !same;
  }
  const bool same = fs::exists(to) && read_file(from) == read_file(to);
  fs::copy_file(from, to, fs::copy_options::overwrite_existing);
  return !same;
}

// A file: in two of three draws one of the journals, which say most; empty files are of no use.
std::string draw_file(const fs::path& root, const std::string& only, RandomStream& random) {
  std::vector<std::string> all, journals;
  for (const auto& name : names_below(root)) {
    if (name.rfind(only, 0) != 0 || fs::file_size(root / name) == 0) continue;
    all.push_back(name);
    if (name.find(".sqlite") != std::string::npos) journals.push_back(name);
  }
  if (all.empty()) return {};
  return journals.empty() || random() % 3 == 0 ? drawn_from(all, random) : drawn_from(journals, random);
}

std::string draw_length(std::uintmax_t size, RandomStream& random) {
  constexpr std::uintmax_t kPage = 4096;
  const std::vector<std::uintmax_t> lengths{0,
                                            1,
                                            size - 1,
                                            size / 2,
                                            random() % size,
                                            random() % size,
                                            random() % (size / kPage + 1) * kPage,
                                            (size - 1) / kPage * kPage};
  return random() % 9 == 0 ? "gone" : std::to_string(drawn_from(lengths, random));
}

// Something of a model for something of the same name here.
std::string draw_mixture(const fs::path& root, const std::string& only, const Models& models, RandomStream& random) {
  std::vector<std::string> folders;
  for (const auto& entry : fs::directory_iterator{root}) {
    const auto name = entry.path().filename().string();
    if (name.rfind(only, 0) == 0) folders.push_back(name);
  }
  std::sort(folders.begin(), folders.end());
  if (folders.empty()) return {};
  const auto names = models.names();
  for (int attempt = 0; attempt < 100; ++attempt) {
    const auto& folder = drawn_from(folders, random);
    const auto& model = drawn_from(names, random);
    std::vector<std::string> parts{"inputs", "tables", "study.sqlite*"};
    for (const auto& file : names_below(models.folder(model))) parts.push_back(file);
    const auto& part = drawn_from(parts, random);
    const bool is_there = part.back() == '*' || fs::exists(models.folder(model) / part);
    const bool is_loose = part == "log.txt" || part == "timings.csv";  // nothing follows from these
    if (is_there && !is_loose) return folder + "/" + part + "=" + model + "/" + part;
  }
  return {};
}

}  // namespace

std::string damaged_name(const std::string& fault) { return fault.substr(0, fault.find_first_of(":=")); }

bool do_damage(const std::string& family, const std::string& fault, const fs::path& root, const Models& models) {
  const auto name = damaged_name(fault);
  if (name.size() == fault.size()) refuse_fault(fault);
  const auto rest = fault.substr(name.size() + 1);
  if (family == "flip") return flip(root / name, rest);
  if (family == "truncate") return truncate(root / name, rest);
  return mix(root / name, models.folder(rest));
}

std::string draw_damage(const std::string& family, const fs::path& root, const std::string& only, const Models& models,
                        RandomStream& random) {
  if (family == "mix") return draw_mixture(root, only, models, random);
  const auto name = draw_file(root, only, random);
  if (name.empty()) return {};
  const auto size = fs::file_size(root / name);
  if (family == "flip") {
    const auto bit = (std::uint64_t{random()} << 32 | random()) % (size * 8);
    return name + ":" + std::to_string(bit);
  }
  return name + ":" + draw_length(size, random);
}

}  // namespace kith::faults
