#include "studies/storing/origin.hpp"

#include <algorithm>
#include <map>
#include <system_error>

#include "studies/storing/journal.hpp"
#include "studies/storing/store_error.hpp"
#include "studies/storing/study_h5.hpp"

namespace acstudy {

namespace fs = std::filesystem;

std::vector<StudyOrigin> stored_studies(const fs::path& folder) {
  std::vector<StudyOrigin> journals, results;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& file = it->path();
    if (const std::string study = study_of_journal(file.filename().string()); !study.empty()) {
      const StoredCases origin = journal_origin(file);
      // Without it nobody knows what its cases are of, unless another says so.
      if (!origin.study_text.empty()) journals.push_back({study, origin.study_file, origin.study_text, file});
    } else if (file.extension() == ".h5" && file.stem() != "bench" && !file.stem().string().starts_with('.')) {
      results.push_back(study_of_h5(file));
    }
  }
  if (error) throw StoreError(folder.string() + ": cannot list the folder: " + error.message());
  // What was run last is in journals, and may be of a text that has changed since.
  std::erase_if(results, [&](const StudyOrigin& result) {
    return std::any_of(journals.begin(), journals.end(), [&](const auto& one) { return one.name == result.name; });
  });
  journals.insert(journals.end(), results.begin(), results.end());
  return journals;
}

}  // namespace acstudy
