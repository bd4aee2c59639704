#include "studies/storing/store.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include "studies/storing/files.hpp"
#include "studies/storing/journal.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/result_json.hpp"
#include "studies/storing/seal.hpp"
#include "studies/storing/store_error.hpp"
#include "studies/storing/study_h5.hpp"

namespace acstudy {

namespace fs = std::filesystem;

StoredCases load_cases(const fs::path& file, bool any_sources) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  StoredCases stored;
  if (fs::exists(file)) {
    try {
      read_study_h5(file, any_sources, stored);
    } catch (const StoreLocked&) {
      throw;
    } catch (const std::exception& error) {
      throw StoreError(
          fmt::format("{}: not a readable result file ({}); remove it, or use --fresh", file.string(), error.what()));
    }
  }
  for (const fs::path& journal : journals_of(file.parent_path(), file.stem().string())) {
    stored.whole = false;
    read_journal(journal, stored);
  }
  return stored;
}

void write_results(const fs::path& out, const StudyResult& result, const Provenance& provenance) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string json = json_text(result, provenance);
  replace_atomically(out / (result.study->name + ".h5"), study_h5(result, provenance, crc(json)));
  replace_atomically(out / (result.study->name + ".json"), json);
  for (const fs::path& journal : journals_of(out, result.study->name)) {
    std::error_code ignored;
    fs::remove(journal, ignored);
  }
}

bool results_stand(const fs::path& out, const StoredCases& stored, const Study& study) {
  if (!stored.whole || stored.study_file != absolute_path(study.file) || stored.findings_key != findings_key(study)) {
    return false;
  }
  const fs::path json = out / (study.name + ".json");
  return fs::exists(json) && crc(bytes_of(json)) == stored.json_seal;
}

}  // namespace acstudy
