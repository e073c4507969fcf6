// Wrong use of the command: one line that names the argument, and nothing done.
#include <doctest/doctest.h>

#include "tests/command/run_command.hpp"
#include "tests/support/gltf_maker.hpp"

using namespace strandlight::test;

TEST_CASE("every subcommand explains itself with examples")
{
    const std::vector<std::vector<std::string>> commands = {
        {},          {"info"}, {"bake"},   {"render"},      {"reference"},
        {"compare"}, {"fits"}, {"report"}, {"nn", "check"}, {"bench", "kernels"}};
    for (std::vector<std::string> arguments : commands) {
        arguments.push_back("--help");
        const CommandResult result = runCommand(arguments);
        CAPTURE(arguments[0]);
        CHECK(result.exitCode == 0);
        CHECK(result.output.find("Examples:") != std::string::npos);
        CHECK(result.errors.empty());
    }
}

TEST_CASE("wrong arguments are named")
{
    const TemporaryFolder folder;
    const std::string out = (folder.path() / "out.").string();
    struct Case
    {
        std::vector<std::string> arguments;
        const char* part;
    };
    const Case cases[] = {
        {{}, "subcommand"},
        {{"paint"}, "paint"},
        {{"bake"}, "SCENE"},
        {{"bake", "builtin:room"}, "--output"},
        {{"bake", "builtin:room", "-o", out + "png"}, ".sgl"},
        {{"bake", "builtin:room", "-o", out + "sgl", "--atlas", "many"}, "--atlas"},
        {{"bake", "builtin:room", "-o", out + "sgl", "--atlas", "1000000"}, "--atlas"},
        {{"bake", "builtin:room", "-o", out + "sgl", "--lobes", "0"}, "--lobes"},
        {{"bake", "builtin:room", "-o", out + "sgl", "--fit", "guess"}, "--fit"},
        {{"bake", "builtin:room", "-o", out + "sgl", "--frobnicate"}, "--frobnicate"},
        {{"bake", "builtin:room", "-o", out + "sgl", "--device", "no such device"},
         "no such device"},
        {{"bake", "builtin:palace", "-o", out + "sgl"}, "builtin:palace"},
        {{"bake", "builtin:furnace:pale", "-o", out + "sgl"}, "pale"},
        {{"reference", "builtin:box", "-o", out + "bmp"}, ".png or .exr"},
        {{"reference", "builtin:box", "-o", out + "png", "--size", "64"}, "--size"},
        {{"reference", "builtin:box", "-o", out + "png", "--size", "0x64"}, "--size"},
        {{"reference", "builtin:box", "-o", out + "png", "--size", "99999x99999"}, "--size"},
        {{"reference", "builtin:box", "-o", out + "png", "--camera", "1,2,3"}, "--camera"},
        {{"reference", "builtin:box", "-o", out + "png", "--camera", "1,2,3,1,2,3"}, "--camera"},
        {{"reference", "builtin:box", "-o", out + "png", "--camera", "0,0,0,1,2,nan"}, "--camera"},
        {{"reference", "builtin:box", "-o", out + "png", "--spp", "0"}, "--spp"},
        {{"reference", "builtin:box", "-o", "no/such/folder/a.png"}, "no/such/folder"},
        {{"reference", "builtin:box", "-o", out + "png", "--json", "no/folder.json"}, "no/folder"},
        {{"render", "builtin:box", "-o", out + "png"}, "--bake"},
        {{"render", "builtin:box", "--bake", "a.sgl", "-o", out + "png", "--view", "x"}, "--view"},
        {{"compare", "a.png"}, "B"},
        {{"nn"}, "subcommand"},
        {{"bench"}, "subcommand"},
        {{"bench", "kernels", "--json", "a.txt"}, ".json"},
        {{"bench", "kernels", "--filter", "no such case"}, "no such case"},
        {{"bench", "gi", "--filter", "no such scene"}, "no such scene"},
        {{"nn", "check"}, "FILES"},
    };
    for (const Case& wrong : cases)
        checkFails(runCommand(wrong.arguments), wrong.part);
    CHECK(listFolder(folder.path()).empty());
}

TEST_CASE("a negative number is a value, not an option")
{
    // The camera's eye starts with a minus sign, as half of all cameras do.
    const TemporaryFolder folder;
    const std::string picture = (folder.path() / "box.exr").string();
    const CommandResult result =
        runCommand({"reference", "builtin:furnace", "-o", picture, "--size", "4x4", "--spp", "1",
                    "--camera", "-0.1,0.1,0.2,0.3,-0.2,0,50", "--exposure", "-1"});
    CAPTURE(result.errors);
    CHECK(result.exitCode == 0);
    CHECK(std::filesystem::exists(picture));
}
