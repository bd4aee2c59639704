#include "studies/storing/journal_record.hpp"

#include <nlohmann/json.hpp>

#include "studies/storing/files.hpp"
#include "studies/storing/finding_h5.hpp"
#include "studies/storing/keys.hpp"

namespace acstudy {

namespace {

using Bytes = nlohmann::json::binary_t::container_type;

template <class T>
Bytes as_bytes(std::span<const T> values) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(values.data());
  return {begin, begin + values.size_bytes()};
}

/// Numbers are kept as bytes: CBOR has one NaN alone.
template <class T>
nlohmann::json packed(const T& value) {
  if constexpr (std::is_arithmetic_v<T>) {
    return nlohmann::json::binary(as_bytes(std::span(&value, 1)));
  } else if constexpr (std::is_same_v<T, std::string>) {
    return nlohmann::json::binary(as_bytes(std::span<const char>(value)));  // as a program has written it
  } else if constexpr (std::is_same_v<T, PointArray>) {
    return {value.dimension, packed(value.coordinates)};
  } else {
    return nlohmann::json::binary(as_bytes(std::span<const typename T::value_type>(value)));
  }
}

template <class T>
void unpack(const nlohmann::json& from, T& value) {
  if constexpr (std::is_same_v<T, PointArray>) {
    value.dimension = std::clamp<std::size_t>(from.at(0).get<std::size_t>(), 1, most_dimensions);
    unpack(from.at(1), value.coordinates);
  } else {
    const Bytes& bytes = from.get_binary();
    if constexpr (std::is_arithmetic_v<T>) {
      if (bytes.size() == sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
    } else {
      using Item = typename T::value_type;
      value.resize(bytes.size() / sizeof(Item));
      if (!value.empty()) std::memcpy(value.data(), bytes.data(), value.size() * sizeof(Item));
    }
  }
}

}  // namespace

RecordBytes study_record(const Study& study) {
  return nlohmann::json::to_cbor(
      {{"study_file", packed(absolute_path(study.file))}, {"study_text", packed(study.text)}});
}

RecordBytes case_record(const std::string& key, const CaseResult& result) {
  nlohmann::json record = {{"case", packed(key)}};
  CaseResult::stored(result, [&](const Stored& as, const auto& value) { record[as.column()] = packed(value); });
  return nlohmann::json::to_cbor(record);
}

RecordBytes finding_record(const std::string& findings_key, std::size_t number, const Finding& finding) {
  const h5::Handle root = h5::create_file_in_memory();
  write_finding(root, "finding", finding);
  return nlohmann::json::to_cbor({{"finding", number}, {"key", findings_key}, {"image", packed(h5::image(root))}});
}

RecordBytes damage_record(const std::string& what) { return nlohmann::json::to_cbor({{"damaged", packed(what)}}); }

RecordBytes origin_record(const StoredCases& stored) {
  return nlohmann::json::to_cbor({{"study_file", packed(stored.study_file)},
                                  {"study_text", packed(stored.study_text)},
                                  {"provenance", stored.provenance}});
}

void add_record(std::span<const std::uint8_t> bytes, StoredCases& stored) {
  const nlohmann::json record = nlohmann::json::from_cbor(bytes.begin(), bytes.end());
  if (record.contains("case")) {
    std::string key;
    unpack(record.at("case"), key);
    CaseResult result;
    result.completed = true;
    CaseResult::stored(result, [&](const Stored& as, auto& value) {
      if (const auto found = record.find(as.column()); found != record.end()) unpack(*found, value);
    });
    stored.cases.insert_or_assign(std::move(key), std::move(result));
  } else if (record.contains("finding")) {
    const auto key = record.at("key").get<std::string>();
    if (!of_these_measurements(key)) return;
    if (key != stored.findings_key) stored.findings.clear();
    stored.findings_key = key;
    std::vector<char> image;
    unpack(record.at("image"), image);
    const h5::Handle root = h5::open_image(image);
    stored.findings.insert_or_assign(record.at("finding").get<std::size_t>(),
                                     read_finding(h5::open_group(root, "finding")));
  } else if (record.contains("damaged")) {
    unpack(record.at("damaged"), stored.damaged.emplace_back());
  } else {
    if (record.contains("provenance")) stored.provenance = record.at("provenance").get<Provenance>();
    unpack(record.at("study_file"), stored.study_file);
    unpack(record.at("study_text"), stored.study_text);
  }
}

}  // namespace acstudy
