// What the parsers of several commands share: reading the words, and options that mean the same everywhere.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "options.h"

namespace vkvol {

// Parses, and turns what CLI11 throws into one line. False: help was asked for and is in options.text.
bool run_parser(CLI::App& app, const std::vector<std::string>& arguments, Options& options);

// CLI::Range lets NaN pass.
CLI::Validator in_range(double low, double high);

inline constexpr long long max_seed = 4294967295;

// For `transform`: 1e2, 010 and 1.0 are none, and the range is said.
CLI::Validator whole_number(long long low, long long high);

// An option that may be given several times.
template <typename T> CLI::Option* add_list(CLI::App& app, const char* name, std::vector<T>& list, const char* help) {
    return app.add_option(name, list, help)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

// --width and --height.
void add_size_options(CLI::App& app, RenderRequest& render);

// --grid and -D.
void add_scene_options(CLI::App& app, RenderRequest& render, std::vector<std::string>& defines, const char* group);

// --spp, --noise, --seed, --integrator, --schedule and --no-cache, of commands that write no pictures of their own.
struct SamplingTexts {
    std::string noise, schedule;
};
void add_sampling_options(CLI::App& app, RenderRequest& render, SamplingTexts& texts, const char* usual_noise);
void finish_sampling(RenderRequest& render, const SamplingTexts& texts);

// As --schedule has it, and what that needs of the device.
void set_schedule(const std::string& text, RenderRequest& render);

// Throws InputError for what --integrator cannot be.
void check_integrator_option(const RenderRequest& render);

// --device, --robust and --validate.
// `several`: devices may share the work.
void add_device_options(CLI::App& app, RenderRequest& render, bool several = false);

} // namespace vkvol
