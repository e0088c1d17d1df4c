/**
 * The messages between the page and Python, as types. Indices count from 0, finding.rule from 1.
 *
 * @typedef {{name: string, holds: boolean}} Precondition
 * @typedef {{p: number, behaviour: string}} BehaviourChange
 * @typedef {{p: number, state: string, value: boolean}} StateChange
 * @typedef {BehaviourChange | StateChange} Action
 * @typedef {"preconditions" | "behaviours" | "actions"} Part
 * @typedef {Precondition | string | Action} RuleElement
 *
 * @typedef {object} Rule
 * @property {string} comment
 * @property {boolean} enabled
 * @property {Precondition[]} preconditions
 * @property {string[]} behaviours
 * @property {Action[]} actions
 *
 * @typedef {object} Origin
 * @property {?string} preset
 * @property {?string} run
 * @property {?number} generation
 * @property {?number} fitness
 *
 * @typedef {{name: string, comment: string, origin: Origin, rules: Rule[]}} RuleSet
 * @typedef {{rule: ?number, element: string, message: string, severity: "error" | "warning"}} Finding
 *
 * @typedef {object} RulesMessage
 * @property {"rules"} type
 * @property {number} version
 * @property {boolean} can_undo
 * @property {boolean} can_redo
 * @property {RuleSet} rule_set
 * @property {Finding[]} findings
 *
 * @typedef {object} Vocabulary
 * @property {{name: string, holds: string, fails: string}[]} preconditions
 * @property {{name: string, doing: string, colour: string}[]} behaviours
 * @property {{name: string, on: string, off: string}[]} internal_states
 * @property {number[]} probabilities
 * @property {{name: string, title: string}[]} presets
 *
 * @typedef {object} LiveMessage
 * @property {"live"} type
 * @property {number} time Simulated time, s.
 * @property {number[]} fired How often each rule has fired since the start, all robots together.
 * @property {number[]} behaviours Robots in each behaviour, in the order of the vocabulary.
 * @property {number} robots
 *
 * @typedef {{type: "file", name: string, text: string}} FileMessage
 * @typedef {{type: "notice", level: "error" | "info", text: string}} NoticeMessage
 *
 * @typedef {object} Edit
 * @property {string} do add_rule, remove_rule, duplicate_rule, move_rule, set_enabled, set_comment,
 *   set_name, add, set or remove; the other fields depend on it.
 */

export {};
