# SPDX-License-Identifier: BSD-3-Clause
"""What sensors do to a running lilod: they fall silent, stick, lie, are of another model, see too
little."""
import os
import socket

from attack_case import Case, attack, expect


@attack
def silence_and_return():
    with Case() as case:
        case.health("silent", "sensor silent")
        case.journal("sensor_silent", "no packet from the sensor yet")
        sensor = case.sensor()
        sensor.on()
        case.health("tracking", without="silent")
        case.journal("sensor_found", "vlp16 at 127.0.0.1, 600 rpm, returns strongest, clock host")
        case.journal("tracking")
        sensor.off()
        case.health("silent", "sensor silent")
        case.journal("sensor_silent", "sensor silent for")
        expect(case.lilod.health["rate_hz"] == 0.0, "no pose, no rate")
        sensor.on()
        case.health("tracking", without="silent")
        case.journal("sensor_back", "scans again after")
    entries = case.lilod.journal.entries
    expect(entries[-1]["EVENT"] == "stopping", "the last word is that it stops")
    for entry in entries:
        expect(entry["SYSLOG_IDENTIFIER"] == "lilod" and entry["INSTANCE"] == "lilod", str(entry))
        expect("SESSION" in entry or not entry["EVENT"], f"no session: {entry}")


@attack
def sensor_upside_down():
    with Case() as case:
        case.sensor(upside_down=True).on()
        case.health("tracking")
        expect(abs(case.lilod.health["tilt_deg"] - 180.0) < 0.5, "its ground is above")
        case.journal("sensor_levelled", "sensor: upside down")


@attack
def frozen_azimuth():
    with Case() as case:
        sensor = case.sensor()
        sensor.on()
        case.health("tracking")
        sensor.frozen_azimuth = True
        case.health("no_scans", "no scans although packets come")
        case.journal("no_scans")
        sensor.frozen_azimuth = False
        case.health("tracking", without="no scans")


@attack
def frozen_stamps():
    with Case() as case:
        sensor = case.sensor()
        sensor.on()
        case.health("tracking")
        sensor.frozen_stamp = True
        case.health("no_scans", "no scans although packets come")
        sensor.frozen_stamp = False
        case.health("tracking", without="no scans")


@attack
def garbage_on_the_port():
    with Case() as case, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        case.sensor().on()
        case.health("tracking")
        for _ in range(100):
            stranger.sendto(os.urandom(300), ("127.0.0.1", case.lilod.ports["data_port"]))
        case.health("tracking", "malformed packets")
        case.journal("faults", "malformed packets 100")
        case.health("tracking", without="malformed", seconds=14)
        expect(case.lilod.metrics()['lilo_packets_malformed_total{instance="lilod"}'] == 100,
               "the count stays")


@attack
def second_sensor_on_the_port():
    with Case() as case:
        case.sensor(address="127.0.0.2").on()
        case.health("tracking")
        second = case.sensor(address="127.0.0.3")
        second.on()
        case.health("tracking", "second sensor")
        case.journal("second_sensor", "127.0.0.2 is followed: set udp.sensor_address")
        expect(case.lilod.health["sensor"]["address"] == "127.0.0.2", "the first is followed")
        second.off()
        case.health("tracking", without="second sensor", seconds=14)


def wrong_sensor(model, complaint, label, **sensor):
    """A sensor that is not the one configured, alone: all say so by name, until it is silent."""
    with Case(model=model) as case:
        sent = case.sensor(**sensor)
        sent.on()
        case.health("no_scans", complaint)
        case.journal("sensor_refused", complaint)
        case.metrics({'lilo_complaint{instance="lilod",kind="wrong_sensor"}': 1,
                      f'lilo_sensor_refused_info{{instance="lilod",model="{label}"}}': 1})
        code, text = case.lilod.status()
        expect(code == 1 and complaint in text, f"lilo status says {code}: {text}")
        sent.off()
        case.health("silent", "sensor silent", without="refused", seconds=16)
        packets = case.lilod.health["packets"]
        expect(packets["wrong_sensor"] > 0 and packets["received"] == packets["malformed"] == 0,
               f"all are of the wrong sensor: {packets}")
        case.metrics({'lilo_complaint{instance="lilod",kind="wrong_sensor"}': 0,
                      'lilo_packets_wrong_sensor_total{instance="lilod"}': packets["wrong_sensor"]})
        expect("sensor" not in case.lilod.health, "no sensor is heard")
        expect(case.lilod.poses == [], "and no pose comes of it")
        told = case.lilod.journal.events().count("sensor_refused")
        expect(told == 1, f"{told} lines in the journal for one thing that is wrong")


@attack
def vlp16_fed_by_hdl64e():
    wrong_sensor("vlp16", "packets of an HDL-64E refused, configured is VLP-16: set sensor.model",
                 "HDL-64E", hdl64e=True)


@attack
def hdl64e_fed_by_vlp16():
    wrong_sensor("hdl64e", "packets of a VLP-16 (product byte 0x22) refused, configured is "
                 "HDL-64E: set sensor.model", "VLP-16")


@attack
def vlp16_fed_by_vlp32c():
    wrong_sensor("vlp16", "packets of a VLP-32C (product byte 0x28) refused, configured is "
                 "VLP-16: set sensor.model", "VLP-32C", product=0x28)


@attack
def vlp16_fed_by_hdl32e():
    wrong_sensor("vlp16", "packets of an HDL-32E (product byte 0x21) refused, configured is "
                 "VLP-16: set sensor.model", "HDL-32E", product=0x21)


@attack
def hdl64e_fed_by_vlp32c():
    wrong_sensor("hdl64e", "packets of a VLP-32C (product byte 0x28) refused, configured is "
                 "HDL-64E: set sensor.model", "VLP-32C", product=0x28)


@attack
def hdl64e_fed_by_hdl32e():
    wrong_sensor("hdl64e", "packets of an HDL-32E (product byte 0x21) refused, configured is "
                 "HDL-64E: set sensor.model", "HDL-32E", product=0x21)


@attack
def auto_fed_by_an_unknown_product():
    wrong_sensor("auto", "packets of an unknown sensor (product byte 0x77) refused: set "
                 "sensor.model", "unknown sensor", product=0x77)


@attack
def two_models_from_one_address():
    """What a switch that hides addresses does: the first is followed, the other one is named."""
    with Case() as case:
        case.sensor().on()
        case.health("tracking")
        complaint = ("packets of a VLP-32C (product byte 0x28) refused, a VLP-16 is followed: use "
                     "another port")
        other = case.sensor(product=0x28)
        other.on()
        case.health("tracking", complaint)
        case.journal("sensor_refused", complaint)
        expect(case.lilod.health["sensor"]["model"] == "vlp16", "the first is followed")
        other.off()
        case.health("tracking", without="refused", seconds=16)
        expect(case.lilod.health["packets"]["lost"] == 0, "nothing of the first was lost")


@attack
def wrong_sensor_before_the_right_one():
    """Each with its own address; the wrong one must not keep the right one out."""
    with Case(model="vlp16") as case:
        complaint = ("packets of a VLP-32C (product byte 0x28) refused, configured is VLP-16: set "
                     "sensor.model")
        wrong = case.sensor(address="127.0.0.3", product=0x28)
        wrong.on()
        case.health("no_scans", complaint)
        case.journal("sensor_refused", complaint)
        case.sensor(address="127.0.0.2").on()
        case.health("tracking", "second sensor")
        case.journal("second_sensor", "127.0.0.2 is followed")
        expect(case.lilod.health["sensor"]["address"] == "127.0.0.2", "the right one is followed")
        wrong.off()
        case.health("tracking", without="second sensor", seconds=16)
        expect(case.lilod.health["complaints"] == [], str(case.lilod.health["complaints"]))


@attack
def packets_lost():
    with Case() as case:
        sensor = case.sensor()
        sensor.on()
        case.health("tracking")
        sensor.loss = 0.02
        case.health(complaint="packets lost")
        case.journal("faults", "packets lost")
        sensor.loss = 0.0
        case.health("tracking", without="packets lost", seconds=20)


@attack
def field_without_a_wall():
    """Nothing tells how far along it is: degraded, and why; then well again."""
    with Case() as case:
        sensor = case.sensor(scenes=("room", "field"))
        sensor.on()
        case.health("tracking")
        sensor.show("field")
        case.health("degraded", "degraded")
        case.journal("degraded", "the scan said")
        sensor.show("room")
        case.health("tracking", without="degraded")
        case.journal("tracking", after="degraded", seconds=15)


@attack
def fog_for_a_moment():
    """Lost, and found again in the same session."""
    with Case() as case:
        sensor = case.sensor(scenes=("room", "fog"))
        sensor.on()
        case.health("tracking")
        session = case.lilod.health["session"]
        sensor.show("fog")
        lost = case.lilod.wait_for_poses(lambda pose: pose["status"] == "lost", 1)
        sensor.show("room")
        expect(lost, "without a return it is lost")
        case.journal("lost", "poses are the prediction alone")
        case.journal("relocalized", "place found again after")
        case.health("tracking", without="lost")
        expect(case.lilod.health["session"] == session, "the session goes on")


@attack
def carried_into_a_corridor():
    """The map is given up for another one."""
    with Case() as case:
        sensor = case.sensor(scenes=("room", "corridor"))
        sensor.on()
        case.health("tracking")
        before = case.lilod.health["session"]
        sensor.show("corridor")
        expect(case.lilod.wait(lambda h: h["session"] != before), "another session")
        case.journal("lost")
        case.journal("session_replaced", f"in place of {before}, whose map was given up")
        case.health(without="lost")


@attack
def more_surface_than_the_map_holds():
    """Cells of 10 cm: the floor alone has more than 10 000."""
    with Case(more="odometry:\n  max_range_m: 20\n  default:\n    cell_m: 0.1\n    map_radius_m: 20\n"
                   "    map_cells: 10000\n") as case:
        sensor = case.sensor()
        sensor.on()
        case.health(complaint="map full")
        case.journal("faults", "map full")
        sensor.off()
        case.health("silent", without="map full", seconds=16)
        refused = case.lilod.health["map_refused"]
        case.metrics({'lilo_map_refused_total{instance="lilod"}': refused})
        expect(refused > 0, "the count stays")
