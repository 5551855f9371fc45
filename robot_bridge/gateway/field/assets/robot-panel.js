/** The panel of the chosen robot: its state, its last task, and which buttons the role may press. */

import { showAnswer } from "/field/banners.js";
import { steadyNow } from "/field/connection.js";
import { stateOf } from "/field/robot-list.js";
import { tr } from "/field/texts.js";

const by = (id) => document.getElementById(id);
const BUTTONS = ["abort", "pause", "resume", "target", "coordinates"];

export class RobotPanel {
  /** Show robot `name`: what the gateway last said of it and of its task, undefined where nothing is known. */
  show(name, { robot, task, role, isCurrent }) {
    by("robot-name").textContent = name;
    by("robot-facts").textContent = robot ? facts(robot, isCurrent).join(" · ") : "";
    const step = task?.steps?.at(-1);
    by("robot-task").textContent = task
      ? tr("Last task: {task}", { task: [task.op, task.state, step?.reason].filter(Boolean).join(", ") })
      : "";
    const may = role !== "viewer";
    for (const id of BUTTONS) by(id).disabled = !may;
    if (!may) this.answer(tr("Your role, {role}, may only look.", { role }), true);
  }

  /** Show what became of what was asked of the robot. */
  answer(text, refused = false) {
    showAnswer("robot-answer", text, refused);
  }
}

function facts(robot, isCurrent) {
  const since = (steadyNow() - robot.at) / 1000, said = [stateOf(robot, isCurrent)];
  // Of very many robots only state and position are sent.
  if (robot.age !== undefined) said.push(tr("heard {s} s ago", { s: Math.round(robot.age + since) }));
  if (robot.x === undefined) said.push(tr("has not said where it is"));
  if (robot.v !== undefined) said.push(`${robot.v.toFixed(1)} m/s`);
  if (robot.pose_age !== undefined) said.push(tr("position {s} s old", { s: Math.round(robot.pose_age + since) }));
  if (robot.battery !== undefined) said.push(tr("battery {n} %", { n: Math.round(100 * robot.battery) }));
  if (robot.doubt) said.push(robot.doubt);
  // Rows repeat the doubt as the status, for programs that do not know it.
  if (robot.status && robot.status !== robot.doubt) said.push(robot.status);
  return said;
}
