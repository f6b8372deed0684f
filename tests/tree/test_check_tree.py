"""Shows that check_tree.py fails on a violation of each rule, and on nothing else."""

import os
import tempfile
import unittest

import check_tree

GOOD = {
    "README.md": "",
    "engine/README.md": "",
    "engine/sph/README.md": "",
    "engine/sph/method/kernel.hpp": "#pragma once\n#include <cmath>\n#include <Eigen/Core>\n",
    "engine/scene/README.md": "",
    "engine/scene/model/scene.cpp": '#include "engine/sph/method/kernel.hpp"\n',
    "engine/store/README.md": "",
    "engine/store/hdf5/file.hpp": "#pragma once\n#include <hdf5.h>\n",
    "engine/store/hdf5/file.cpp": '#include "engine/store/hdf5/file.hpp"\n#include <hdf5.h>\n',
    "service/README.md": "",
    "service/api/api.cpp": '#include "engine/store/hdf5/file.hpp"\n#include "sluice/version.hpp"\n',
    "cli/README.md": "",
    "cli/main.cpp": '#include "engine/store/hdf5/file.hpp"\n',
}


class CheckTree(unittest.TestCase):
    def found_in(self, files):
        """Violations of a tree of these files (name: text; None: left out), with a README in each room."""
        rooms = {f"{check_tree.module_of(name)}/{check_tree.floor_of(name)[0]}" for name in files
                 if check_tree.floor_of(name)}
        files = {**{f"{room}/README.md": "" for room in rooms}, **files}
        with tempfile.TemporaryDirectory() as root:
            for name, text in files.items():
                if text is None:
                    continue
                path = os.path.join(root, name)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w", encoding="utf-8") as stream:
                    stream.write(text)
            return check_tree.violations(root)

    def assert_one(self, found, words):
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def with_file(self, name, text):
        return self.found_in({**GOOD, name: text})

    def test_a_tree_that_keeps_the_rules_passes(self):
        self.assertEqual(self.found_in(GOOD), [])

    def test_an_include_against_the_direction_is_found(self):
        found = self.with_file("engine/sph/method/x.cpp", '#include "engine/store/hdf5/file.hpp"\n')
        self.assert_one(found, "engine/sph may not include from engine/store")

    def test_an_include_with_blanks_in_it_is_found_too(self):
        found = self.with_file("engine/sph/method/x.cpp", ' #  include "engine/store/hdf5/file.hpp"\n')
        self.assert_one(found, "engine/sph may not include from engine/store")

    def test_a_room_may_include_from_the_floors_below_it_alone(self):
        files = {"engine/scene/model/scene.hpp": "#pragma once\n", "engine/scene/checks/parse.hpp": "#pragma once\n"}
        down = '#include "engine/scene/model/scene.hpp"\n'
        up = '#include "engine/scene/checks/parse.hpp"\n'
        self.assertEqual(self.found_in({**GOOD, **files, "engine/scene/checks/parse.cpp": down}), [])
        self.assert_one(self.found_in({**GOOD, **files, "engine/scene/model/scene.cpp": up}),
                        "engine/scene/model may not include from engine/scene/checks")

    def test_a_room_without_a_readme_is_found(self):
        self.assert_one(self.found_in({**GOOD, "engine/sph/method/README.md": None}),
                        "engine/sph/method: has no README.md")

    def test_a_source_beside_the_rooms_is_found(self):
        self.assert_one(self.found_in({**GOOD, "engine/scene/stray.cpp": "\n"}), "is in no room of engine/scene")

    def test_the_service_may_include_studies_and_the_store_may_not(self):
        files = {"engine/study/README.md": "", "engine/study/study.hpp": "#pragma once\n"}
        line = '#include "engine/study/study.hpp"\n'
        self.assertEqual(self.found_in({**GOOD, **files, "service/api/studies.cpp": line}), [])
        self.assert_one(self.found_in({**GOOD, **files, "engine/store/disk/x.cpp": line}),
                        "engine/store may not include from engine/study")

    def test_the_service_may_not_include_the_run(self):
        files = {"engine/run/README.md": "", "engine/run/run.hpp": "#pragma once\n",
                 "service/worker/worker.cpp": '#include "engine/run/run.hpp"\n'}
        self.assert_one(self.found_in({**GOOD, **files}), "service may not include from engine/run")

    def test_only_the_service_and_the_command_line_may_start_processes(self):
        files = {"engine/execute/README.md": "", "engine/execute/executor.hpp": "#pragma once\n",
                 "engine/run/README.md": ""}
        line = '#include "engine/execute/executor.hpp"\n'
        for name in ("service/scheduler/attempt.cpp", "cli/study.cpp"):
            self.assertEqual(self.found_in({**GOOD, **files, name: line}), [])
        self.assert_one(self.found_in({**GOOD, **files, "engine/run/loop.cpp": line}),
                        "engine/run may not include from engine/execute")

    def test_an_axis_that_is_named_outside_of_the_border_is_found(self):
        for named in ("place.y()", "frame.vx", "particles.position[0]", "frame.origin_x"):
            line = f"double value = {named};  // the y() of a comment is none\n"
            self.assert_one(self.with_file("engine/store/files/x.cpp", line), "names an axis of space")
            self.assertEqual(self.with_file("engine/sph/method/x.cpp", line), [])

    def test_hdf5_outside_its_room_is_found(self):
        for name in ("engine/store/disk/other.cpp", "tests/store/raw.cpp"):
            found = self.found_in({**GOOD, name: "#include <hdf5.h>\n", "tests/README.md": ""})
            self.assert_one(found, "hdf5.h may be included in engine/store/hdf5/ alone")

    def test_httplib_belongs_to_one_pair_of_the_service_and_one_of_the_command_line(self):
        both = {"service/http/http_response.cpp": "#include <httplib.h>\n",
                "cli/client/http_client.cpp": "#include <httplib.h>\n"}
        self.assertEqual(self.found_in({**GOOD, **both}), [])
        for name in ("engine/store/disk/fetch.cpp", "service/http/http_head.cpp", "cli/client/other.cpp"):
            third = {**GOOD, **both, name: "#include <httplib.h>\n"}
            self.assert_one(self.found_in(third), "httplib.h may be included in")

    def test_the_method_may_not_use_files_json_or_logging(self):
        for header in ("fstream", "nlohmann/json.hpp", "fmt/format.h"):
            found = self.with_file("engine/sph/method/x.cpp", f"#include <{header}>\n")
            self.assert_one(found, f"engine/sph may not include {header}")

    def test_an_include_that_is_not_from_the_root_is_found(self):
        found = self.with_file("engine/sph/method/x.cpp", '#include "kernel.hpp"\n')
        self.assert_one(found, "not a path from the root")

    def test_an_include_of_a_missing_file_is_found(self):
        found = self.with_file("engine/sph/method/x.cpp", '#include "engine/sph/none.hpp"\n')
        self.assert_one(found, "does not exist")

    def test_a_path_of_a_machine_is_found(self):
        for folder in ("home", "root", "work", "tmp"):
            found = self.with_file("cli/notes.txt", f"see /{folder}/someone/notes\n")
            self.assert_one(found, "path of a machine")

    def test_a_path_below_a_variable_or_in_a_word_is_none(self):
        text = '"$folder/tmp/x" "${folder}' + '/work' + '/y" src/home/z\n'
        self.assertEqual(self.with_file("cli/notes.txt", text), [])

    def test_a_folder_without_a_readme_is_found(self):
        self.assert_one(self.found_in({**GOOD, "cli/README.md": None}), "cli: has no README.md")
        self.assert_one(self.found_in({**GOOD, "engine/sph/README.md": None}),
                        "engine/sph: has no README.md")

    def test_an_unknown_name_at_the_top_is_found(self):
        self.assert_one(self.with_file("notes.txt", ""), "not a known top-level name")


if __name__ == "__main__":
    unittest.main()
