#include "studies/commands/forecast/plan_json.hpp"

#include <nlohmann/json.hpp>

#include "studies/storing/json_form.hpp"
#include "studies/storing/keys.hpp"

namespace acstudy {

std::string plan_json(std::span<const StudyForecast> studies) {
  using json = nlohmann::ordered_json;
  json cases = json::array(), totals = json::array();
  for (const StudyForecast& study : studies) {
    totals.push_back({{"study", study.study->name}, {"seconds", study.seconds()}, {"bytes", study.bytes()}});
    for (const SeriesForecast& series : study.series) {
      for (std::size_t i = 0; i < series.cases.size(); ++i) {
        const CaseForecast& one = series.cases[i];
        const Case& c = *one.plan.c;
        json record = {{"study", study.study->name},
                       {"series", series.series->label()},
                       {"N", c.N},
                       {"h", c.h},
                       {"delta", c.delta},
                       {"dt", c.dt},
                       {"steps", c.steps},
                       {"form", one.plan.form->name},
                       {"seconds", one.seconds ? json(*one.seconds) : json()},
                       {"bytes", one.bytes},
                       {"key", storage_key(c)}};
        if (i >= series.series->cases_at_first()) record["if_undecided"] = true;
        cases.push_back(std::move(record));
      }
    }
  }
  return json_form::pretty({{"studies", totals}, {"cases", cases}}) + "\n";
}

}  // namespace acstudy
