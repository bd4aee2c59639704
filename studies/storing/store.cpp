#include "studies/storing/store.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include "studies/storing/files.hpp"
#include "studies/storing/journal.hpp"
#include "studies/storing/result_json.hpp"
#include "studies/storing/store_error.hpp"
#include "studies/storing/study_h5.hpp"

namespace acstudy {

namespace fs = std::filesystem;

StoredCases load_cases(const fs::path& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  StoredCases stored;
  if (fs::exists(file)) {
    try {
      read_study_h5(file, stored);
    } catch (const StoreLocked&) {
      throw;
    } catch (const std::exception& error) {
      throw StoreError(
          fmt::format("{}: not a readable result file ({}); remove it, or use --fresh", file.string(), error.what()));
    }
  }
  read_journal(journal_path(file.parent_path(), file.stem().string()), stored);
  return stored;
}

void write_results(const fs::path& out, const StudyResult& result, const Provenance& provenance) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  replace_atomically(out / (result.study->name + ".h5"), study_h5(result, provenance));
  replace_atomically(out / (result.study->name + ".json"), json_text(result, provenance));
  std::error_code ignored;
  fs::remove(journal_path(out, result.study->name), ignored);
}

}  // namespace acstudy
