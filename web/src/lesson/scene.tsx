// A board that plays, with its caption and its description in words. Without a map: the steps as a list.
import type { ComponentChildren, JSX } from 'preact';
import { BoardView } from '../shared/board/board';
import type { Legend } from '../shared/board/legend';
import { closedAt, played } from '../shared/board/repeats';
import type { Board, Frame, Path, Place } from '../shared/board/types';
import { usePlayback } from '../shared/playback';
import type { Domain } from './document';
import { Player } from './player';
import { actionsText, cellText, endText, listed, mapText, placedStepText, placeOf, upperFirst } from './words';

// What is said about a map of which only a part is shown.
const kWindow = {
  part: 'This is a part of the map. Drag it, press on the small map, or use the arrow keys to see the rest.',
  label: 'A part of the map. The arrow keys move it.',
  whole: 'Show the whole map',
  enlarge: 'Enlarge the map',
};

export interface Context {
  domain: Domain;
  legend: Legend;
}

interface SceneProps extends Context {
  board: Board;
  name: string; // "the robot's path"
  title: string;
  other?: Path;
  decisive?: { frame: number; cell?: Place } | null;
  isCutOff?: boolean; // the run is longer than what is shown
  children?: ComponentChildren;
}

export function Scene(props: SceneProps): JSX.Element {
  return (
    <figure class="scene">
      <h4>{props.title}</h4>
      {props.board.map ? <PlayedBoard {...props} /> : <Steps {...props} />}
      {props.children && <figcaption>{props.children}</figcaption>}
      <InWords {...props} />
    </figure>
  );
}

function labelOf({ board, name, other, decisive }: SceneProps): string {
  const from = board.start.robot ? ` from ${cellText(board.start.robot)}` : '';
  const parting = decisive?.cell ? `, separating at ${cellText(decisive.cell)}` : '';
  return (
    `Map with ${name}${from}: ${actionsText(board)}.` +
    (other ? ` Dashed, the path you might have expected${parting}: ${actionsText(other)}.` : '')
  );
}

function PlayedBoard({ other, ...props }: SceneProps): JSX.Element {
  const { board } = props;
  const frames = played(board);
  const others = other && played(other);
  const playback = usePlayback(Math.max(frames.length, others?.length ?? 0) - 1);
  const longer = others && others.length > frames.length ? others : frames;
  const step = Math.min(playback.step, frames.length - 1);
  return (
    <>
      <BoardView
        {...props}
        board={{ ...board, frames }}
        closedAt={closedAt(board)}
        {...(other && others ? { other: others, otherClosedAt: closedAt(other) } : {})}
        step={step}
        walked={playback.step}
        label={labelOf({ ...props, ...(other ? { other } : {}) })}
        path
        texts={kWindow}
      />
      <Player
        frames={step < playback.step ? holding(frames, longer) : frames}
        playback={playback}
        what={props.name}
        end={endText(board, props.isCutOff)}
      />
    </>
  );
}

// The robot has arrived while the other one is still moving.
function holding(frames: Frame[], longer: Frame[]): Frame[] {
  const last = frames[frames.length - 1];
  return longer.map((_, i) => frames[i] ?? last ?? {});
}

function Steps({ board, other, decisive, name, isCutOff }: SceneProps): JSX.Element {
  const last = ({ repeats_from, repeats_text }: Path): string => {
    if (repeats_from === undefined) return isCutOff ? 'and so on' : 'the end';
    return `from step ${repeats_from + 1} on all over again${repeats_text ? `: ${repeats_text}` : ''}`;
  };
  const list = (path: Path, title: string, first: number): JSX.Element => (
    <div>
      <p class="list-title">{title}</p>
      <ol class="steps" start={first + 1}>
        {path.frames.slice(first).map((frame, i) => (
          <li class={decisive?.frame === first + i ? 'parting' : undefined}>
            {frame.robot ? upperFirst(placeOf(frame)) : (frame.state ?? 'a state')}
            {`: ${frame.action ?? last(path)}`}
            {decisive?.frame === first + i && <span class="mark">here they separate</span>}
          </li>
        ))}
      </ol>
    </div>
  );
  return (
    <div class={other ? 'step-lists two' : 'step-lists'}>
      {list(board, upperFirst(name), 0)}
      {other && list(other, 'What you might have expected', decisive?.frame ?? 0)}
    </div>
  );
}

function InWords(props: SceneProps): JSX.Element | null {
  const { domain, legend, board, other, decisive } = props;
  if (!board.map) return null;
  const things = (frames: Frame[], first: number): JSX.Element => (
    <ol start={first + 1}>
      {frames.slice(first, -1).map((frame, i) => (
        <li>{placedStepText(frame, frames[first + i + 1])}</li>
      ))}
    </ol>
  );
  return (
    <details class="in-words">
      <summary>This picture and its path in words</summary>
      {mapText(domain, legend, board).map((text) => (
        <p>{text}</p>
      ))}
      <p>The robot:</p>
      {things(board.frames, 0)}
      {board.repeats_from !== undefined && <p>{endText(board)}</p>}
      {other && <p>What you might have expected instead, from step {(decisive?.frame ?? 0) + 1} on:</p>}
      {other && things(other.frames, decisive?.frame ?? 0)}
      {other && other.repeats_from !== undefined && <p>{endText(other)}</p>}
    </details>
  );
}

// What the world is called, where a picture does not tell all of it.
export function WorldName({ board }: { board: Board }): JSX.Element | null {
  return board.world_name ? <p class="world-name">This world: {board.world_name}.</p> : null;
}

// What is to be seen before an answer is given: the board with nobody having moved.
export function Start({ domain, legend, board }: Context & { board: Board }): JSX.Element {
  const text = mapText(domain, legend, board);
  if (!board.map) return <p>{listed(text)}</p>;
  return (
    <BoardView
      domain={domain}
      legend={legend}
      board={board}
      step={0}
      label={`Map before the robot moves. ${text.join(' ')}`}
      texts={kWindow}
    />
  );
}
