# SPDX-License-Identifier: BSD-3-Clause
"""What the computer does to a running lilod: full sockets, a dead network card, a stalled disk, a clock
that is set."""
import os
import subprocess
import time

from attack_case import Case, attack, expect, stop_thread
from lilod_world import Lilod, binary, preloaded


def rest(case, complaint, count):
    """The complaint goes away, the count stays."""
    case.health("tracking", without=complaint, seconds=16)
    name, value = count
    expect(value > 0, f"{name} is {value}")
    case.metrics({f'{name}{{instance="lilod"}}': value})


@attack
def receiver_without_cpu():
    """Stopped for three seconds, it finds its socket full."""
    yaml = Lilod.YAML.replace("udp:\n", "udp:\n  receive_buffer_bytes: 1048576\n")
    with Case(yaml=yaml) as case:
        case.sensor().on()
        case.health("tracking")
        go_on = stop_thread(case.lilod.process.pid, "lilo-receiver")
        time.sleep(3.0)
        go_on()
        complaint = "packets dropped by the kernel"
        case.health(complaint=complaint)
        case.journal("faults", complaint)
        rest(case, complaint, ("lilo_packets_kernel_dropped_total",
                               case.lilod.health["packets"]["kernel_dropped"]))


@attack
def network_card_that_is_down():
    """Reading fails: told, counted, and no core is spun away."""
    case = Case(environment=preloaded("broken_system"), variables={
        "BROKEN_NETWORK_FILE": "{folder}/down"})
    with case:
        case.sensor().on()
        case.health("tracking")
        down = case.lilod.folder + "/down"
        open(down, "w").close()
        case.health("silent", "receive errors")
        case.journal("faults", "receive errors")
        case.journal("sensor_silent")
        errors, cpu_s = case.lilod.health["receive_errors"], case.lilod.cpu_s()
        time.sleep(2.0)
        expect(case.lilod.cpu_s() - cpu_s < 1.0, "2 s of errors took more than a second of CPU")
        os.remove(down)
        case.health("tracking", without="silent")
        expect(errors > 0, "they are counted")
        case.health("tracking", without="receive errors", seconds=16)


@attack
def clock_that_is_set():
    """By an hour."""
    case = Case(environment=preloaded("step_clock"), variables={"STEP_CLOCK_FILE": "{folder}/step"})
    with case:
        case.sensor().on()
        case.health("tracking")
        open(case.lilod.folder + "/step", "w").close()
        complaint = "the computer's clock was set"
        case.health(complaint=complaint)
        case.journal("clock_set", "the computer's clock was set by +3600.0")
        rest(case, complaint, ("lilo_clock_steps_total", case.lilod.health["clock_steps"]))


def hdl64e_recording(folder):
    """Six seconds of an HDL-64E, which sends its table in four."""
    subprocess.run([binary("lilo"), "sim", folder + "/hdl64e", "--sensor", "hdl64-s3",
                    "--duration-s", "6", "--world", "corridor"], check=True, capture_output=True)
    return folder + "/hdl64e/data.pcap"


def play(case, recording):
    """At sensor speed; ends when the recording does."""
    ports = case.lilod.ports
    return subprocess.Popen([binary("lilo"), "replay", recording, "--data-port",
                             str(ports["data_port"]), "--position-port",
                             str(ports["position_port"])], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


@attack
def calibration_that_is_stored():
    with Case(model="hdl64e", more="state:\n  directory: {folder}\n") as case:
        player = play(case, hdl64e_recording(case.lilod.folder))
        case.health(complaint="waiting for the calibration")
        case.journal("calibration_waiting", "waiting for the calibration")
        case.journal("calibration_read", "calibration read", seconds=15)
        case.journal("calibration_stored", "hdl64e_calibration.yaml")
        case.health("tracking", without="calibration")
        player.wait()


@attack
def calibration_with_a_pipe_in_its_place():
    with Case(model="hdl64e", more="state:\n  directory: {folder}\n") as case:
        for ending in ("", ".new"):
            os.mkfifo(f"{case.lilod.folder}/hdl64e_calibration.yaml{ending}")
        player = play(case, hdl64e_recording(case.lilod.folder))
        case.journal("calibration_not_stored", "hdl64e_calibration.yaml", seconds=15)
        case.health("tracking", without="calibration")
        expect(case.lilod.health["packets"]["lost"] == 0, "nothing is lost over it")
        player.wait()


@attack
def calibration_on_a_disk_that_stalls():
    """Who writes it waits for ever: no packet is lost, and SIGTERM ends the process all the same."""
    with Case(model="hdl64e", more="state:\n  directory: {folder}\n", exit_code=1,
              environment={**preloaded("broken_system"), "STALLED_FILE": "hdl64e_calibration"}) as case:
        player = play(case, hdl64e_recording(case.lilod.folder))
        case.journal("calibration_read", seconds=15)
        case.health("tracking", without="calibration")
        player.wait()
        expect(case.lilod.health["packets"]["lost"] == 0, "nothing is lost over it")
        expect("calibration_stored" not in case.lilod.journal.events(), "it is not stored")


@attack
def metrics_on_a_disk_that_stalls():
    with Case(exit_code=1, environment={**preloaded("broken_system"),
                                        "STALLED_FILE": "lilo.prom"}) as case:
        case.sensor().on()
        case.health("tracking", "metrics file not written")
        case.journal("not_saved", "lilo.prom")
