"""Small valid files, which the tests of `io` damage."""

TASKS = "2 3 100 50\n0 1 2 20 255\n1 3 4 20 100\n2 5 6 20 30\n"
AGENTS = "2 100 50\n0 9 10 2.0\n1 7 8 1.0\n"

SCENARIO = """{
  "format": "mrta_zoo.scenario",
  "version": 1,
  "map": {"width": 100, "height": 50},
  "tasks": [
    {"x": 1, "y": 2, "deadline": 255, "workload": 20},
    {"x": 3, "y": 4, "deadline": 100, "workload": 20}
  ],
  "robots": [{"x": 5, "y": 6, "capacity": 1, "speed": 1}]
}"""

TABLE = """kind,x,y,deadline,workload,capacity,speed
map,100,50,,,,
task,1,2,255,20,,
task,3,4,100,20,,
robot,5,6,,,2,1
"""

PLAN = '{\n  "format": "mrta_zoo.plan",\n  "version": 1,\n  "routes": [[0, 2], [1]]\n}'

TRACE = """{
  "format": "mrta_zoo.trace",
  "version": 1,
  "method": "hand",
  "mask_rule": "feasible",
  "map": {"width": 100, "height": 50},
  "tasks": [
    {"x": 3, "y": 4, "deadline": 20, "workload": 10},
    {"x": 3, "y": 10, "deadline": 99, "workload": 2}
  ],
  "robots": [{"x": 0, "y": 0, "capacity": 2}],
  "decisions": [
    {"time": 0, "robot": 0, "task": 0, "probabilities": [[0, 0.75], [1, 0.25]]},
    {"time": 10, "robot": 0, "task": null, "advice": 1}
  ]
}
"""
