#include "studies/commands/run/earlier_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "studies/commands/say.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/keys.hpp"
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

/// Throws if results of the other form of the schemes would be dropped, which the study does not ask for in this run.
void require_one_form(const Study& study, const StoredCases& stored, const RunOptions& options) {
  const auto of_form = [&](const std::string& key, bool readable) {
    return key.find("|program=") == std::string::npos && (key.find("|form=readable") != std::string::npos) == readable;
  };
  const auto any = [&](bool readable) {
    return std::any_of(stored.cases.begin(), stored.cases.end(),
                       [&](const auto& one) { return of_form(one.first, readable); });
  };
  if (options.fresh || study.series.empty() || !any(!options.readable) || any(options.readable)) return;
  throw InputError(
      fmt::format("{}: holds results of the {} form, which would be dropped; name another folder with "
                  "--out, or replace them with --fresh",
                  (options.out / (study.name + ".h5")).string(), options.readable ? "vector" : "readable"));
}

void say_damaged(const std::vector<std::string>& damaged) {
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < std::min(most, damaged.size()); ++i) {
    say(fmt::format("note: {}: not as it was written; it is left out, and what is missing for that is computed anew",
                    damaged[i]));
  }
  if (damaged.size() > most) say(fmt::format("note: so are {} others", damaged.size() - most));
}

/// Adds what another folder has of a study whose findings have this key.
void add(StoredCases other, const std::string& key, StoredCases& to) {
  to.cases.merge(other.cases);
  to.whole = false;
  if (to.findings_key != key) {
    to.findings = std::move(other.findings);
    to.findings_key = other.findings_key;
  } else if (other.findings_key == key) {
    to.findings.merge(other.findings);
  }
  to.damaged.insert(to.damaged.end(), other.damaged.begin(), other.damaged.end());
}

}  // namespace

EarlierResults earlier_results(const std::vector<Study>& studies, const RunOptions& options) {
  EarlierResults results;
  for (const Study& study : studies) {
    const std::string file = study.name + ".h5";
    StoredCases stored;
    try {
      stored = load_cases(options.out / file);
    } catch (const StoreLocked&) {
      throw;
    } catch (const StoreError&) {
      if (!options.fresh) throw;
    }
    require_own_results(study, stored, options.out);
    require_one_form(study, stored, options);
    const std::string key = options.stores.empty() ? "" : findings_key(study);
    for (const std::filesystem::path& folder : options.stores) add(load_cases(folder / file), key, stored);
    say_damaged(stored.damaged);
    results.cases.merge(stored.cases);
    results.each.push_back(std::move(stored));
  }
  return results;
}

}  // namespace acstudy
