/**
 * The messages between the page and Python, as types. Indices count from 0, finding.rule from 1.
 *
 * @typedef {boolean | number | string} Value
 * @typedef {{name: string, arguments: Value[]}} Term
 * @typedef {"==" | "!=" | ">=" | "<=" | ">" | "<"} Comparison
 * @typedef {{percept: Term, comparison: Comparison, value: Value}} Precondition
 * @typedef {{p: number, behaviour: Term}} BehaviourChange
 * @typedef {{p: number, state: string, operation: "=" | "+=" | "-=", value: Value}} StateChange
 * @typedef {BehaviourChange | StateChange} Action
 * @typedef {"preconditions" | "behaviours" | "actions"} Part
 * @typedef {Precondition | Term | Action} RuleElement
 *
 * @typedef {object} Rule
 * @property {string} comment
 * @property {boolean} enabled
 * @property {Precondition[]} preconditions
 * @property {Term[]} behaviours
 * @property {Action[]} actions
 *
 * @typedef {object} Origin
 * @property {?string} preset
 * @property {?string} run
 * @property {?number} generation
 * @property {?number} fitness
 *
 * @typedef {{name: string, comment: string, origin: Origin, rules: Rule[]}} RuleSet
 * @typedef {"error" | "warning" | "hint"} Severity A hint is true but harmless.
 * @typedef {{rule: ?number, element: string, message: string, severity: Severity}} Finding
 *
 * @typedef {object} RulesMessage
 * @property {"rules"} type
 * @property {number} version
 * @property {boolean} can_undo
 * @property {boolean} can_redo
 * @property {RuleSet} rule_set
 * @property {Finding[]} findings
 * @property {string[]} [english] Each rule as a sentence.
 * @property {string} [text] The rule set in the rule language.
 * @property {string[]} [rule_texts] Each rule in the rule language.
 * @property {RuleSet} [loaded] The version loaded last.
 * @property {string} [loaded_text] The same in the rule language.
 * @property {number} [simpler] Elements that can go without changing the behaviour; absent while
 *   unknown.
 *
 * @typedef {{name: string, unit: string, offered: Value[]}} Argument
 *
 * @typedef {object} Vocabulary Words may hold arguments in braces.
 * @property {{name: string, holds: string, fails: string, arguments: Argument[], values: Value[],
 *   comparisons: Comparison[]}[]} preconditions
 * @property {{name: string, doing: string, colour: string, arguments: Argument[]}[]} behaviours
 * @property {{name: string, on: string, off: string, values: Value[], counts: boolean}[]} internal_states
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
 * @typedef {object} MachineState
 * @property {string} label
 * @property {string} behaviour
 * @property {string} means What robots in it do, in words.
 * @property {boolean} initial
 *
 * @typedef {object} Transition
 * @property {number} source Index of a state.
 * @property {number} target
 * @property {string} when Its condition.
 * @property {string} rate Probability per control step and mean waiting time, in words.
 * @property {string[]} effects What it does besides, in words.
 * @property {number[]} rules Numbers of the rules behind it, from 1.
 * @property {string} words All of this in a line.
 *
 * @typedef {object} StatesMessage
 * @property {"states"} type
 * @property {string} svg Drawn by geswarm.exports.brief_svg.
 * @property {MachineState[]} states
 * @property {Transition[]} transitions
 *
 * @typedef {object} ActivityMessage What the swarm does in the machine sent last.
 * @property {"activity"} type
 * @property {number} time Simulated time, s.
 * @property {number} swarm Robots in all.
 * @property {number[]} robots In each state.
 * @property {number[]} taken How often each transition was taken since the rules were set.
 *
 * @typedef {"current" | "before" | "evo8" | "hand-coded"} Role
 * @typedef {{role: Role, name: string, collected: number[]}} Sample Collected objects of each run.
 *
 * @typedef {object} Comparison Mean of the current rules minus mean of the other's, same seeds.
 * @property {Role} role The other rules.
 * @property {number} difference
 * @property {number} low Ends of the 95 % interval.
 * @property {number} high
 * @property {?number} p_value
 *
 * @typedef {object} VerdictMessage
 * @property {"verdict"} type
 * @property {number} version
 * @property {string} scenario
 * @property {number} runs How many there will be in each sample.
 * @property {boolean} busy
 * @property {Sample[]} samples
 * @property {Comparison[]} comparisons
 *
 * @typedef {object} Piece Mean without the piece minus mean with it, and its 95 % interval.
 * @property {number} rule
 * @property {"rule" | Part} part
 * @property {?number} at
 * @property {number} difference
 * @property {number} low
 * @property {number} high
 *
 * @typedef {object} WorthMessage
 * @property {"worth"} type
 * @property {number} version
 * @property {boolean} busy
 * @property {number} done
 * @property {number} total
 * @property {Piece[]} pieces
 *
 * @typedef {object} SimplifiedMessage
 * @property {"simplified"} type
 * @property {number} version
 * @property {RuleSet} rule_set
 * @property {string} text
 * @property {string[]} removed
 *
 * @typedef {Finding & {line: ?number}} TextFinding
 * @typedef {{type: "text_findings", findings: TextFinding[]}} TextFindingsMessage
 *
 * @typedef {{type: "file", name: string, text: string}} FileMessage
 * @typedef {{type: "people", people: {name: string, you: boolean}[]}} PeopleMessage
 * @typedef {{type: "changed", who: string, what: string}} ChangedMessage Somebody else did that.
 *
 * @typedef {object} StaleMessage A change was not made: it was meant for another version.
 * @property {"stale"} type
 * @property {number} version The one that it was meant for.
 * @property {string} text
 *
 * @typedef {object} Unsaved Rules of a dashboard that was killed.
 * @property {string} file
 * @property {string} name
 * @property {number} rules How many.
 * @property {number} edited Seconds since 1970.
 * @typedef {{type: "unsaved", left: Unsaved[]}} UnsavedMessage
 *
 * @typedef {object} NoticeMessage
 * @property {"notice"} type
 * @property {"error" | "info"} level
 * @property {string} text Empty: what it is about is over.
 * @property {string} [about] "journal", or absent: what was asked for last.
 *
 * @typedef {object} Edit
 * @property {string} do add_rule, remove_rule, duplicate_rule, move_rule, set_enabled, set_comment,
 *   set_name, add, set, remove or paste_rules; the other fields depend on it.
 */

export {};
