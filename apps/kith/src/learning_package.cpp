#include "learning_package.hpp"

#include <fmt/format.h>

#include <boost/crc.hpp>
#include <cstdint>

namespace kith::cli {
namespace {

// Little endian.
void put(std::string& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 255u);
}

std::string escaped_xml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') {
      escaped += c;  // XML has no other control characters
    }
  }
  return escaped;
}

// What both headers of a file say: version, flags (names are UTF-8), method, time (1980-01-01), checksum, sizes, length
// of the name, nothing more.
std::string described_file(const PackedFile& file) {
  constexpr std::uint32_t kVersion = 20, kUtf8 = 1u << 11u, kFirstDay = 33;
  boost::crc_32_type crc;
  crc.process_bytes(file.content.data(), file.content.size());
  std::string bytes;
  put(bytes, kVersion, 2);
  put(bytes, kUtf8, 2);
  put(bytes, 0, 4);
  put(bytes, kFirstDay, 2);
  put(bytes, static_cast<std::uint32_t>(crc.checksum()), 4);
  put(bytes, static_cast<std::uint32_t>(file.content.size()), 4);
  put(bytes, static_cast<std::uint32_t>(file.content.size()), 4);
  put(bytes, static_cast<std::uint32_t>(file.name.size()), 2);
  put(bytes, 0, 2);
  return bytes;
}

}  // namespace

std::string stored_zip(const std::vector<PackedFile>& files) {
  std::string bytes, directory;
  for (const auto& file : files) {
    const auto description = described_file(file);
    const auto begin = static_cast<std::uint32_t>(bytes.size());
    bytes += "PK\x03\x04" + description + file.name + file.content;
    directory += "PK\x01\x02";
    put(directory, 20, 2);  // made by version
    directory += description;
    put(directory, 0, 2);  // no comment
    put(directory, 0, 2);  // the first disk
    put(directory, 0, 2);  // attributes
    put(directory, 0, 4);
    put(directory, begin, 4);
    directory += file.name;
  }
  const auto begin = static_cast<std::uint32_t>(bytes.size());
  bytes += directory + "PK\x05\x06";
  put(bytes, 0, 4);
  put(bytes, static_cast<std::uint32_t>(files.size()), 2);
  put(bytes, static_cast<std::uint32_t>(files.size()), 2);
  put(bytes, static_cast<std::uint32_t>(directory.size()), 4);
  put(bytes, begin, 4);
  put(bytes, 0, 2);
  return bytes;
}

std::string scorm_manifest(const std::string& title, const std::string& id) {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<manifest identifier="kith-{1}" version="1.0" xmlns="http://www.imsproject.org/xsd/imscp_rootv1p1p2"
          xmlns:adlcp="http://www.adlnet.org/xsd/adlcp_rootv1p2">
  <metadata>
    <schema>ADL SCORM</schema>
    <schemaversion>1.2</schemaversion>
  </metadata>
  <organizations default="course">
    <organization identifier="course">
      <title>{0}</title>
      <item identifier="lesson" identifierref="page">
        <title>{0}</title>
      </item>
    </organization>
  </organizations>
  <resources>
    <resource identifier="page" type="webcontent" adlcp:scormtype="sco" href="lesson.html">
      <file href="lesson.html"/>
    </resource>
  </resources>
</manifest>
)",
                     escaped_xml(title), id);
}

std::string cmi5_course(const std::string& title, const std::string& id) {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<courseStructure xmlns="https://w3id.org/xapi/profiles/cmi5/v1/CourseStructure.xsd">
  <course id="urn:kith:lesson:{1}">
    <title><langstring lang="en">{0}</langstring></title>
    <description><langstring lang="en">How a robot decides: watch it, predict it, see why.</langstring></description>
  </course>
  <au id="urn:kith:lesson:{1}:page" moveOn="CompletedOrPassed" launchMethod="AnyWindow">
    <title><langstring lang="en">{0}</langstring></title>
    <description><langstring lang="en">How a robot decides: watch it, predict it, see why.</langstring></description>
    <url>lesson.html</url>
  </au>
</courseStructure>
)",
                     escaped_xml(title), id);
}

}  // namespace kith::cli
