"""The plug-in for pytest, used by tests of others: pytester runs them in a folder of their own."""
import pytest

BUS = """bus: {interface: eth-that-is-not-there, cycle_time_us: 1000}
axes:
  - {name: Lift, position: 1, motor: CM1-E-17S30D, unit: {counts_per_unit: 5000}}
"""


@pytest.fixture
def run(pytester):
    def run(text, **outcomes):
        pytester.makepyfile(text)
        result = pytester.runpytest("-p", "no:cacheprovider")
        result.assert_outcomes(**outcomes)
        return result
    return run


def test_default_bus(run):
    run("""
        def test_move(cm1e_bus):
            x = cm1e_bus["X"]
            x.enable()
            x.move_absolute(1, 5)
            assert cm1e_bus.virtual_time and abs(x.position - 1) < 0.01
        def test_begins_anew(cm1e_bus):
            assert cm1e_bus.time < 0.001 and cm1e_bus["X"].position == 0
        """, passed=2)


def test_bus_file_beside_the_test_is_simulated(run, pytester):
    pytester.makefile(".yaml", machine=BUS)
    run("""
        import pytest
        @pytest.mark.cm1e_bus("machine.yaml")
        def test_file(cm1e_bus):
            cm1e_bus["Lift"].enable()
            assert len(cm1e_bus.axes) == 1
        """, passed=1)


def test_bus_file_of_the_configuration(run, pytester):
    pytester.makefile(".yaml", machine=BUS)
    pytester.makeini("[pytest]\ncm1e_bus_file = machine.yaml\n")
    run("""
        def test_file(cm1e_bus):
            assert cm1e_bus.axes[0].name == "Lift"
        """, passed=1)


def test_axes_and_groups(run):
    run("""
        import pytest
        pytestmark = pytest.mark.cm1e_bus(axes=["A", {"name": "B", "counts_per_unit": 5000}], groups=["G"])
        def test_names(cm1e_bus):
            assert [axis.name for axis in cm1e_bus.axes] == ["A", "B"]
            assert cm1e_bus.group("G").state == 0
        """, passed=1)


def test_fault_of_the_console_fails_the_test_that_does_not_expect_it(run):
    result = run("""
        import pytest
        def fail(bus):
            bus["X"].enable()
            bus.simulate("power 1 off")
            bus.advance(0.2)
        def test_unexpected(cm1e_bus):
            fail(cm1e_bus)
        @pytest.mark.cm1e_bus(error_stop=True)
        def test_expected(cm1e_bus):
            fail(cm1e_bus)
        """, passed=2, errors=1)
    result.stdout.fnmatch_lines(["*ErrorStop at the end of the test*", "*motor power*"])


def test_exception_of_the_machine_program_is_that_of_the_test(run):
    result = run("""
        def test_wrong(cm1e_bus):
            x = cm1e_bus["X"]
            x.move_relative(1, 1)
        """, failed=1)
    result.stdout.fnmatch_lines(["*enable it with MC_Power*"])


@pytest.mark.parametrize("mark, said", [
    ('"none.yaml"', "there is no bus file"), ("axis=1", "axis: expected a bus file"),
    ('"machine.yaml"', "machine.yaml:3"), ("axes=[{'nam': 'X'}]", "there is no nam; there are name")])
def test_mistakes_are_told(run, pytester, mark, said):
    pytester.makefile(".yaml", machine=BUS.replace("counts_per_unit", "counts_per_unity"))
    result = run(f"""
        import pytest
        @pytest.mark.cm1e_bus({mark})
        def test_mistake(cm1e_bus):
            pass
        """, errors=1)
    assert said in result.stdout.str()


def test_help_knows_it(pytester):
    result = pytester.runpytest("--markers")
    result.stdout.fnmatch_lines(["*cm1e_bus(bus_file, axes=*"])
