#pragma once

/// @file
/// The scenes that a study can name.

#include <memory>
#include <stdexcept>
#include <string>

#include "mms/scene.hpp"

namespace acstudy::test {

inline std::shared_ptr<const Scene> named_scene(const std::string& name) {
  for (const SceneText& text : named_scenes()) {
    if (text.name == name) return std::make_shared<const Scene>(text);
  }
  throw std::logic_error("no scene " + name);
}

}  // namespace acstudy::test
