// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/checkpoint_observer.h"

#include "bpm/app/version.h"
#include "bpm/dynamics/share_state.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/io/input_error.h"
#include "bpm/packing/sound_packing.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

// Names of this file; the simulation's own have no slash.
const std::string packing_prefix = "packing/";
const std::string last_steps_name = "output/last_steps";
const std::string strain_path_name = "output/strain_path";
const std::string motion_name = "output/motion";

bool is_simulation_name(const std::string& name) {
  return name.find('/') == std::string::npos && name != "modulus";
}

std::vector<double> flat(const std::vector<Vector3>& vectors) {
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Vector3& v : vectors) {
    numbers.insert(numbers.end(), v.data(), v.data() + 3);
  }
  return numbers;
}

std::vector<Vector3> vectors(const std::vector<double>& numbers) {
  std::vector<Vector3> result(numbers.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  return result;
}

void store_template(CheckpointData& data, const GrainTemplate& grain, const std::string& name) {
  data.real[name + "/position"] = flat(grain.position);
  data.real[name + "/volume"] = {grain.reference_volume};
  data.integer[name + "/at_rest"] = {is_at_rest(grain) ? 1 : 0};
  std::vector<double>& r0 = data.real[name + "/r0"];
  std::vector<std::int64_t>& ends = data.integer[name + "/bonds"];
  for (const Bond& bond : grain.bonds) {
    r0.push_back(bond.r0);
    ends.insert(ends.end(), {bond.i, bond.j});
  }
  if (grain.period) {
    data.real[name + "/period"] = {(*grain.period)[0], (*grain.period)[1], (*grain.period)[2]};
  }
}

/// What a checkpoint holds is data: sums that fit do not mean that its parts fit together.
void require(bool is_so, const std::string& what) {
  if (!is_so) {
    throw std::invalid_argument(what);
  }
}

bool all_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

GrainTemplate read_template(const CheckpointData& data, const std::string& name) {
  GrainTemplate grain;
  grain.position = vectors(data.real.at(name + "/position"));
  grain.reference_volume = data.real.at(name + "/volume").at(0);
  const std::vector<double>& r0 = data.real.at(name + "/r0");
  const std::vector<std::int64_t>& ends = data.integer.at(name + "/bonds");
  require(ends.size() == 2 * r0.size() && !grain.position.empty(), name + " has bonds without ends, or no nodes");
  require(all_finite(data.real.at(name + "/position")) && all_finite(r0), name + " holds numbers that are not finite");
  for (std::size_t b = 0; b < r0.size(); ++b) {
    require(ends[2 * b] >= 0 && ends[2 * b] < ends[2 * b + 1] && ends[2 * b + 1] < grain.n_nodes() && r0[b] > 0.0,
            name + " has a bond between nodes that are not there");
    grain.bonds.push_back({static_cast<int>(ends.at(2 * b)), static_cast<int>(ends.at(2 * b + 1)), r0[b]});
  }
  if (const auto period = data.real.find(name + "/period"); period != data.real.end()) {
    grain.period = vectors(period->second).at(0);
    require(grain.period->allFinite() && grain.period->minCoeff() > 0.0, name + " has a period that is not positive");
  }
  return grain;
}

void store_packing(CheckpointData& data, const Packing& packing) {
  const std::string& p = packing_prefix;
  for (std::size_t t = 0; t < packing.templates.size(); ++t) {
    store_template(data, *packing.templates[t], fmt::format("{}template{}", p, t));
  }
  const Box& box = packing.box;
  data.real[p + "box"] = {box.h().data(), box.h().data() + 9};
  data.real[p + "origin"] = {box.origin().data(), box.origin().data() + 3};
  data.integer[p + "periodic"] = {box.periodic()[0], box.periodic()[1], box.periodic()[2]};
  std::vector<std::int64_t>& grains = data.integer[p + "grains"];
  for (const Grain& grain : packing.grains) {
    grains.insert(grains.end(), {grain.template_index, grain.species, grain.molecule});
    data.real[p + "alpha"].push_back(grain.alpha);
  }
  data.integer[p + "id"] = packing.id;
  data.real[p + "position"] = flat(packing.position);
}

bool is_at_rest_there(const CheckpointData& data, std::size_t t) {
  const auto found = data.integer.find(fmt::format("{}template{}/at_rest", packing_prefix, t));
  return found != data.integer.end() && found->second.at(0) != 0;
}

Packing read_packing(const CheckpointData& data) {
  const std::string& p = packing_prefix;
  Packing packing;
  for (std::size_t t = 0; data.real.contains(fmt::format("{}template{}/position", p, t)); ++t) {
    packing.templates.push_back(
        std::make_shared<const GrainTemplate>(read_template(data, fmt::format("{}template{}", p, t))));
  }
  const std::vector<std::int64_t>& periodic = data.integer.at(p + "periodic");
  packing.box = Box(vectors(data.real.at(p + "origin")).at(0), Vector3::Ones(), Vector3::Zero(),
                    {periodic.at(0) != 0, periodic.at(1) != 0, periodic.at(2) != 0});
  const std::vector<double>& h = data.real.at(p + "box");
  require(h.size() == 9 && all_finite(h) && h[0] > 0.0 && h[4] > 0.0 && h[8] > 0.0 && h[1] == 0.0 && h[2] == 0.0 &&
              h[5] == 0.0,
          "the cell's vectors are not those of a cell");
  packing.box.set_h(Eigen::Map<const Matrix3>(h.data()));
  const std::vector<std::int64_t>& grains = data.integer.at(p + "grains");
  const std::vector<double>& alpha = data.real.at(p + "alpha");
  require(grains.size() == 3 * alpha.size() && !alpha.empty() && all_finite(alpha),
          "grains without a template or alpha");
  for (std::size_t g = 0; g < alpha.size(); ++g) {
    require(grains[3 * g] >= 0 && grains[3 * g] < static_cast<std::int64_t>(packing.templates.size()),
            "a grain names a template that is not there");
    packing.grains.push_back(
        {static_cast<int>(grains.at(3 * g)), static_cast<int>(grains.at(3 * g + 1)), alpha[g], grains.at(3 * g + 2)});
  }
  packing.id = data.integer.at(p + "id");
  packing.position = vectors(data.real.at(p + "position"));
  const auto n = static_cast<std::size_t>(packing.first_nodes().back());
  require(packing.position.size() == n && packing.id.size() == n && all_finite(data.real.at(p + "position")),
          "positions or ids do not belong to the grains");
  packing.velocity.assign(packing.position.size(), Vector3::Zero());
  check_sound(packing);
  for (std::size_t t = 0; t < packing.templates.size(); ++t) {
    require(!is_at_rest_there(data, t) || is_at_rest(*packing.templates[t]),
            fmt::format("rest lengths of template {} are not those of its undeformed nodes", t));
  }
  return packing;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    result.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

} // namespace

CheckpointData constant_part(const RunSetup& setup, const Simulation& simulation) {
  CheckpointData data;
  if (!simulation.ranks().is_root()) {
    return data;
  }
  data.text["scene"] = setup.scene.text;
  data.text["scene_path"] = setup.scene.path.string();
  std::string& overrides = data.text["overrides"];
  for (const std::string& assignment : setup.scene.overrides) {
    overrides += assignment + "\n";
  }
  data.text["version"] = version_text();
  data.text["instruction_set"] = simulation.instruction_set();
  if (setup.modulus) {
    data.real["modulus"] = {*setup.modulus};
  }
  store_packing(data, simulation.packing());
  return data;
}

void share_checkpoint(LatestCheckpoint& checkpoint, const Ranks& ranks) {
  if (ranks.is_distributed()) {
    share_but_nodes(checkpoint.data.text, ranks);
    share_but_nodes(checkpoint.data.real, ranks);
    share_but_nodes(checkpoint.data.integer, ranks);
    std::string path = checkpoint.path.string();
    ranks.broadcast(path);
    checkpoint.path = path;
  }
}

RunSetup setup_from(const LatestCheckpoint& checkpoint, const OutputFolder& folder) {
  const CheckpointData& data = checkpoint.data;
  try {
    Scene scene =
        read_stored_scene(data.text.at("scene"), data.text.at("scene_path"), lines(data.text.at("overrides")));
    RunSetup setup{std::move(scene), folder, read_packing(data), {}, std::nullopt, false, std::nullopt};
    if (const auto modulus = data.real.find("modulus"); modulus != data.real.end()) {
      setup.modulus = modulus->second.at(0);
    }
    RunSetup::Restart restart;
    for (const auto& [name, values] : data.real) {
      if (is_simulation_name(name)) {
        restart.state.real[name] = values;
      }
    }
    for (const auto& [name, values] : data.integer) {
      if (is_simulation_name(name)) {
        restart.state.integer[name] = values;
      }
    }
    restart.step = data.integer.at("step").at(0);
    restart.last_steps = data.integer.at(last_steps_name);
    if (const auto path = data.real.find(strain_path_name); path != data.real.end()) {
      require(path->second.size() == 4 && all_finite(path->second), "the path of the strain is not four numbers");
      restart.strain_path = path->second;
    }
    if (const auto motion = data.real.find(motion_name); motion != data.real.end()) {
      restart.motion = motion->second;
    }
    restart.file = checkpoint.path.string();
    setup.restart = std::move(restart);
    return setup;
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: cannot be gone on from: {}", checkpoint.path.string(), error.what()));
  } catch (const std::out_of_range&) {
    throw InputError(fmt::format("{}: a part is missing; it was written by another version ({})",
                                 checkpoint.path.string(),
                                 data.text.contains("version") ? data.text.at("version") : "unknown"));
  }
}

void store_writers(CheckpointData& data, const RunWriters& writers) {
  data.integer[last_steps_name] = writers.last_steps();
  data.real[strain_path_name] = writers.table->strain_path().saved();
  if (writers.motion) {
    data.real[motion_name] = writers.motion->save_motion();
  }
}

bool CheckpointObserver::wants(const StepForecast& forecast) {
  now_ = forecast.seconds;
  due_ = schedule_.due(forecast) || now_ - last_ >= every_seconds_;
  return due_;
}

void CheckpointObserver::observe(const Simulation& simulation, const StageProgress&) {
  if (due_) { // the run writes those between stages itself
    write(simulation);
    due_ = false;
  }
}

std::filesystem::path CheckpointObserver::write(const Simulation& simulation) {
  const auto belongs_to_simulation = [](const auto& entry) { return is_simulation_name(entry.first); };
  std::erase_if(data_.real, belongs_to_simulation); // what an earlier stage stored may have no successor
  std::erase_if(data_.integer, belongs_to_simulation);
  SavedState state = simulation.save();
  last_ = now_;
  for (auto& [name, values] : state.real) {
    data_.real[name] = std::move(values);
  }
  for (auto& [name, values] : state.integer) {
    data_.integer[name] = std::move(values);
  }
  store_writers_(data_);
  const std::vector<std::int64_t> first_node = simulation.packing().first_nodes();
  return write_checkpoint(folder_, data_, simulation.ranks(),
                          {{entries_of_nodes.begin(), entries_of_nodes.end()},
                           node_runs(simulation.own_grains(), first_node),
                           first_node.back()});
}

} // namespace boba
