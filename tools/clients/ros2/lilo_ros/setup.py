# SPDX-License-Identifier: BSD-3-Clause
from setuptools import setup

setup(
    name="lilo_ros",
    version="0.1.0",
    packages=["lilo_ros"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/lilo_ros"]),
        ("share/lilo_ros", ["package.xml"]),
        ("share/lilo_ros/config", ["config/lilo.yaml"]),
        ("share/lilo_ros/launch", ["launch/lilo.launch.py"]),
    ],
    install_requires=["setuptools"],
    license="BSD-3-Clause",
    entry_points={"console_scripts": ["bridge = lilo_ros.bridge:main"]},
)
