#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "kith/files/atomic_file.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"

namespace kith::testing {

/// Makes the manifest of a run folder agree with the files that are there, as if the run had written them; a folder
/// without a manifest gets one. For tests of what reads files behind their checksums.
inline void reseal(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  using Json = nlohmann::ordered_json;
  const auto file = folder / kManifestFile;
  Json manifest{{"schema", "kith.manifest/2"}, {"run", "none"}, {"exit_reason", "finished"}};
  if (fs::exists(file)) manifest = Json::parse(read_file(file));
  manifest.erase("checksum");
  for (const auto* group : {"inputs", "tables"}) {
    manifest[group] = Json::object();
    if (!fs::exists(folder / group)) continue;
    for (const auto& entry : fs::directory_iterator{folder / group})
      manifest[group][entry.path().filename().string()] = sha256(read_file(entry.path()));
  }
  write_file_atomically(file, sealed_manifest(manifest.dump()));
}

}  // namespace kith::testing
