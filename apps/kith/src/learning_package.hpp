#pragma once

#include <string>
#include <vector>

namespace kith::cli {

struct PackedFile {
  std::string name;
  std::string content;
};

/// An archive of files, as they are (APPNOTE.TXT of ZIP, method 0). The same files give the same bytes.
[[nodiscard]] std::string stored_zip(const std::vector<PackedFile>& files);

/// What learning systems read of a lesson, lesson.html in the same archive: imsmanifest.xml of SCORM 1.2, and cmi5.xml.
/// @param id  tells lessons apart.
[[nodiscard]] std::string scorm_manifest(const std::string& title, const std::string& id);
[[nodiscard]] std::string cmi5_course(const std::string& title, const std::string& id);

}  // namespace kith::cli
