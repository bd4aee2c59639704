#include "studies/commands/run/earlier_results.hpp"

#include <fmt/format.h>

#include "studies/reading/input_error.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace {

/// Throws if results would be lost that belong to another study file. A file that was moved or copied as it is does as
/// well as the one that it comes from.
void require_own_results(const Study& study, const StoredCases& stored, const std::filesystem::path& out) {
  if (stored.study_file.empty() || stored.study_file == absolute_path(study.file) || stored.study_text == study.text) {
    return;
  }
  const std::filesystem::path result = out / (study.name + ".h5");
  throw InputError(
      fmt::format("{}: study \"{}\" would replace the results of {}, a study of the same name, in {}; name another "
                  "folder with --out, give it another name, or remove these results",
                  study.file, study.name, stored.study_file, result.string()));
}

}  // namespace

EarlierResults earlier_results(const std::vector<Study>& studies, const RunOptions& options) {
  EarlierResults results;
  for (const Study& study : studies) {
    StoredCases stored;
    try {
      stored = load_cases(options.out / (study.name + ".h5"));
    } catch (const StoreLocked&) {
      throw;
    } catch (const StoreError&) {
      if (!options.fresh) throw;
    }
    require_own_results(study, stored, options.out);
    results.cases.merge(stored.cases);
    results.each.push_back(std::move(stored));
  }
  return results;
}

}  // namespace acstudy
